#include "common/surface_file.hpp"

#include "common/atomic_file.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <iterator>

namespace kerf {

namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t header_bytes = 84; // text, then the number of facets
constexpr std::size_t facet_bytes = 50;  // normal, three corners, two bytes of no meaning
constexpr std::size_t normal_bytes = 12;

void add_facet(const FacetShape<3>& corners, Surface<3>& surface) {
  const auto first = static_cast<std::uint32_t>(surface.vertices.size());
  surface.vertices.insert(surface.vertices.end(), corners.begin(), corners.end());
  surface.facets.push_back({first, first + 1, first + 2});
}

std::uint32_t announced_facets(const std::string& bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + header_bytes - sizeof count, sizeof count);
  return count;
}

Surface<3> parse_binary(const std::string& bytes) {
  Surface<3> surface;
  for (std::size_t at = header_bytes; at < bytes.size(); at += facet_bytes) {
    std::array<float, 9> x;
    std::memcpy(x.data(), bytes.data() + at + normal_bytes, sizeof x);
    add_facet({Vec<3>(x[0], x[1], x[2]), Vec<3>(x[3], x[4], x[5]), Vec<3>(x[6], x[7], x[8])},
              surface);
  }
  return surface;
}

/// Goes to the next line, which must begin with a word.
void expect(TextFile& file, std::string_view word) {
  if (!file.next())
    file.fail(fmt::format("the file ends where \"{}\" is expected", word));
  if (file.first() != word)
    file.fail(fmt::format("\"{}\" is found where \"{}\" is expected", file.first(), word));
}

Surface<3> read_ascii(const std::filesystem::path& path) {
  TextFile file(path, '\0');
  Surface<3> surface;
  std::vector<std::size_t> line;
  expect(file, "solid");
  while (file.next()) {
    if (file.first() == "solid" || file.first() == "endsolid")
      continue;
    if (file.first() != "facet")
      file.fail(fmt::format("\"{}\" is found where \"facet\" is expected", file.first()));
    line.push_back(file.line_number());
    FacetShape<3> corners;
    expect(file, "outer");
    for (Vec<3>& corner : corners) {
      expect(file, "vertex");
      corner = {file.number(1), file.number(2), file.number(3)};
    }
    expect(file, "endloop");
    expect(file, "endfacet");
    add_facet(corners, surface);
  }
  return finish_surface(path, surface, line);
}

} // namespace

Surface<3> read_stl(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path))
    throw FileError(fmt::format("{} cannot be opened", path.string()));
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());

  // Binary files may begin with "solid", too: the size tells.
  const bool has_header = bytes.size() >= header_bytes;
  if (has_header && bytes.size() == header_bytes + facet_bytes * announced_facets(bytes))
    return finish_surface<3>(path, parse_binary(bytes), {});
  if (bytes.find_first_not_of(" \t\r\n") == bytes.find("solid") && !bytes.empty())
    return read_ascii(path);
  throw FileError(
      has_header
          ? fmt::format("{} is no STL file: it does not begin with \"solid\", and as a binary file "
                        "of {} facets it must have {} bytes, but has {}",
                        path.string(), announced_facets(bytes),
                        header_bytes + facet_bytes * announced_facets(bytes), bytes.size())
          : fmt::format("{} is no STL file: it does not begin with \"solid\", and with {} bytes "
                        "it is too short for a binary one",
                        path.string(), bytes.size()));
}

void write_stl(const std::filesystem::path& path, const Surface<3>& surface) {
  std::string bytes(header_bytes, '\0');
  const auto count = static_cast<std::uint32_t>(surface.facets.size());
  std::memcpy(bytes.data() + header_bytes - sizeof count, &count, sizeof count);
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const FacetShape<3> corners = surface.shape(f);
    std::array<float, 12> numbers;
    auto next = numbers.begin();
    for (const Vec<3>& x :
         {scaled_normal<3>(corners).normalized().eval(), corners[0], corners[1], corners[2]})
      for (const double component : x)
        *next++ = static_cast<float>(component);
    bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    bytes.append(facet_bytes - sizeof numbers, '\0');
  }
  write_text(path, bytes);
}

} // namespace kerf
