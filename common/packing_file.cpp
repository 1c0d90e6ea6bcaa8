#include "common/packing_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace kerf {

namespace {

using Point = std::array<double, 3>;

/// A packing file as text, and what all its formats have in common.
class PackingText : public TextFile {
public:
  explicit PackingText(const std::filesystem::path& path)
      : TextFile(path, '#'), name_(path.string()) {}

  void must_follow(const char* what) {
    if (!next())
      throw FileError(fmt::format("{} ends where {} should follow", name_, what));
  }
  double radius(std::size_t word) const {
    const double value = number(word);
    if (!(value > 0.0))
      fail(fmt::format("the radius {} m must be positive", value));
    return value;
  }

private:
  std::string name_;
};

/// What a file holds. Lines of x y r have no z.
struct Content {
  std::vector<Point> points; // m
  std::vector<double> radii; // m
  bool is_plane = false;
};

/// @param format_line  of YADE's text export, which may have columns after the radius
Content read_lines(PackingText& file, std::optional<int> dim, bool has_format_line) {
  Content content;
  std::size_t columns = dim ? static_cast<std::size_t>(*dim) + 1 : 0; // 0: as in the first line
  if (has_format_line)
    columns = 4;
  while (file.next()) {
    const std::size_t found = file.words().size();
    if (columns == 0)
      columns = found == 3 ? 3 : 4;
    if (found < columns || (found > columns && !has_format_line))
      file.fail(fmt::format("a line must hold {} values, {}, but this one holds {}", columns,
                            columns == 3 ? "x y r" : "x y z r", found));
    Point point{};
    for (std::size_t a = 0; a + 1 < columns; ++a)
      point[a] = file.number(a);
    content.points.push_back(point);
    content.radii.push_back(file.radius(columns - 1));
  }
  content.is_plane = columns == 3;
  return content;
}

/// Numbers that go on over as many lines as they like.
std::vector<double> read_numbers(PackingText& file, std::size_t count, const char* what) {
  std::vector<double> numbers;
  while (numbers.size() < count) {
    file.must_follow(what);
    for (std::size_t word = 0; word < file.words().size(); ++word)
      numbers.push_back(file.number(word));
  }
  if (numbers.size() > count)
    file.fail(
        fmt::format("{} end here with {} numbers instead of {}", what, numbers.size(), count));
  return numbers;
}

Content read_vtk(PackingText& file) {
  file.must_follow("a title");
  file.must_follow("ASCII");
  if (file.first() != "ASCII")
    file.fail(fmt::format("legacy VTK must be ASCII, not {}", file.first()));
  Content content;
  bool is_point_data = false;
  while (file.next()) {
    const std::string_view key = file.first();
    if (key == "POINTS" && file.words().size() == 3) {
      const std::size_t count = file.count(1);
      const std::vector<double> x = read_numbers(file, 3 * count, "coordinates");
      for (std::size_t i = 0; i < count; ++i)
        content.points.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    } else if (key == "POINT_DATA" || key == "CELL_DATA") {
      is_point_data = key == "POINT_DATA";
    } else if (is_point_data && key == "SCALARS" && file.words().size() > 1 &&
               (file.words()[1] == "radius" || file.words()[1] == "Radius")) {
      file.must_follow("LOOKUP_TABLE");
      content.radii = read_numbers(file, content.points.size(), "radii");
      for (const double radius : content.radii)
        if (!(radius > 0.0))
          file.fail(fmt::format("the radius {} m must be positive", radius));
    }
  }
  if (content.radii.size() != content.points.size())
    file.fail("the points have no scalar \"radius\"");
  return content;
}

/// The atoms of one moment; the header of their columns is the line before.
Content read_moment(PackingText& file, std::size_t count) {
  const std::size_t width = file.words().size() - 2; // after ITEM: ATOMS
  const auto column = [&](std::string_view name) {
    const auto& words = file.words();
    const auto found = std::find(words.begin() + 2, words.end(), name);
    if (found == words.end())
      file.fail(fmt::format("the atoms have no column \"{}\"", name));
    return static_cast<std::size_t>(found - words.begin()) - 2;
  };
  const std::array<std::size_t, 4> wanted = {column("x"), column("y"), column("z"),
                                             column("radius")};
  const std::size_t id = column("id");
  std::vector<std::pair<double, std::array<double, 4>>> atoms;
  for (std::size_t i = 0; i < count; ++i) {
    file.must_follow("an atom");
    if (file.words().size() != width)
      file.fail(fmt::format("an atom must have {} values, but this one has {}", width,
                            file.words().size()));
    auto& [key, values] = atoms.emplace_back(file.number(id), std::array<double, 4>{});
    for (std::size_t k = 0; k < 3; ++k)
      values[k] = file.number(wanted[k]);
    values[3] = file.radius(wanted[3]);
  }
  std::stable_sort(atoms.begin(), atoms.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Content content;
  for (const auto& [key, values] : atoms) {
    content.points.push_back({values[0], values[1], values[2]});
    content.radii.push_back(values[3]);
  }
  return content;
}

/// The last moment of a dump.
Content read_dump(PackingText& file) {
  Content content;
  std::size_t count = 0;
  while (file.next()) {
    if (file.words().size() < 2 || file.first() != "ITEM:")
      continue; // a value of an item that does not matter
    if (file.words()[1] == "NUMBER") {
      file.must_follow("the number of atoms");
      count = file.count(0);
    } else if (file.words()[1] == "ATOMS") {
      content = read_moment(file, count);
    }
  }
  return content;
}

Content read_content(const std::filesystem::path& path, std::optional<int> dim) {
  std::string first;
  std::getline(std::ifstream(path), first);
  PackingText file(path);
  if (first.starts_with("# vtk DataFile"))
    return read_vtk(file);
  if (first.starts_with("ITEM:"))
    return read_dump(file);
  return read_lines(file, dim, first.starts_with("#format x_y_z_r"));
}

} // namespace

Packing read_packing(const std::filesystem::path& path, std::optional<int> dim) {
  Content content = read_content(path, dim);
  if (content.radii.empty())
    throw PackingError(fmt::format("{} holds no particle", path.string()));
  const bool is_flat = std::all_of(content.points.begin(), content.points.end(),
                                   [](const Point& point) { return point[2] == 0.0; });
  if (dim == 2 && !is_flat)
    throw PackingError(fmt::format("{} holds particles with z other than zero", path.string()));
  if (dim == 3 && content.is_plane)
    throw PackingError(fmt::format("{} holds lines of x y r, without z", path.string()));

  Packing packing;
  packing.dim = dim ? *dim : (is_flat ? 2 : 3);
  packing.radii = std::move(content.radii);
  for (const Point& point : content.points)
    packing.positions.insert(packing.positions.end(), point.begin(), point.begin() + packing.dim);
  return packing;
}

} // namespace kerf
