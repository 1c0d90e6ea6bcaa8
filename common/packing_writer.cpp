#include "common/atomic_file.hpp"
#include "common/packing_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace kerf {

namespace {

using Text = fmt::memory_buffer;

/// Appends the fewest digits that read back to the same bits.
template <class... Values>
void add(Text& text, fmt::format_string<Values...> format, Values&&... values) {
  fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
}

void add_point(Text& text, const Packing& packing, std::size_t i, int coordinates) {
  for (int a = 0; a < coordinates; ++a) {
    const auto at = i * static_cast<std::size_t>(packing.dim) + static_cast<std::size_t>(a);
    add(text, "{}{}", a == 0 ? "" : " ", a < packing.dim ? packing.positions[at] : 0.0);
  }
}

void add_lines(Text& text, const Packing& packing, int coordinates) {
  for (std::size_t i = 0; i < packing.radii.size(); ++i) {
    add_point(text, packing, i, coordinates);
    add(text, " {}\n", packing.radii[i]);
  }
}

void add_vtk(Text& text, const Packing& packing, const std::string& comment) {
  const std::size_t count = packing.radii.size();
  add(text, "# vtk DataFile Version 3.0\n{}\nASCII\nDATASET POLYDATA\nPOINTS {} double\n",
      comment.substr(0, 250), count);
  for (std::size_t i = 0; i < count; ++i) {
    add_point(text, packing, i, 3);
    add(text, "\n");
  }
  add(text, "VERTICES {} {}\n", count, 2 * count);
  for (std::size_t i = 0; i < count; ++i)
    add(text, "1 {}\n", i);
  add(text, "POINT_DATA {}\nSCALARS radius double 1\nLOOKUP_TABLE default\n", count);
  for (const double radius : packing.radii)
    add(text, "{}\n", radius);
}

/// The box of a dump is that around the particles.
void add_dump(Text& text, const Packing& packing) {
  const auto dim = static_cast<std::size_t>(packing.dim);
  add(text, "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n",
      packing.radii.size());
  for (std::size_t a = 0; a < 3; ++a) {
    double lower = 0.0, upper = 0.0;
    for (std::size_t i = 0; i < packing.radii.size(); ++i) {
      const double x = a < dim ? packing.positions[i * dim + a] : 0.0, r = packing.radii[i];
      lower = i == 0 ? x - r : std::min(lower, x - r);
      upper = i == 0 ? x + r : std::max(upper, x + r);
    }
    add(text, "{} {}\n", lower, upper);
  }
  add(text, "ITEM: ATOMS id type x y z radius\n");
  for (std::size_t i = 0; i < packing.radii.size(); ++i) {
    add(text, "{} 1 ", i + 1);
    add_point(text, packing, i, 3);
    add(text, " {}\n", packing.radii[i]);
  }
}

} // namespace

PackingFormat packing_format(const std::filesystem::path& path) {
  const std::string extension = path.extension();
  if (extension == ".vtk")
    return PackingFormat::vtk;
  if (extension == ".dump" || extension == ".liggghts" || extension == ".lammpstrj")
    return PackingFormat::dump;
  return extension == ".yade" ? PackingFormat::yade : PackingFormat::text;
}

void write_packing(const std::filesystem::path& path, const Packing& packing, PackingFormat format,
                   const std::string& comment) {
  Text text;
  switch (format) {
  case PackingFormat::text:
    add(text, "# {}\n# {}, m\n", comment, packing.dim == 2 ? "x y r" : "x y z r");
    add_lines(text, packing, packing.dim);
    break;
  case PackingFormat::yade:
    add(text, "#format x_y_z_r\n# {}\n", comment);
    add_lines(text, packing, 3);
    break;
  case PackingFormat::vtk:
    add_vtk(text, packing, comment);
    break;
  case PackingFormat::dump:
    add_dump(text, packing);
    break;
  }
  write_text(path, {text.data(), text.size()});
}

} // namespace kerf
