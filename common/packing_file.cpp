#include "common/packing_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

namespace kerf {

namespace {

using Words = std::vector<std::string_view>;
using Point = std::array<double, 3>;

/// The lines of a file, and errors that name them.
class Lines {
public:
  explicit Lines(const std::filesystem::path& path) : path_(path), file_(path) {
    if (!file_ || std::filesystem::is_directory(path))
      throw PackingError(fmt::format("{} cannot be opened", path.string()));
  }

  /// The words of the next line, nothing at the end of the file. Comments are no words.
  std::optional<Words> next() {
    if (!std::getline(file_, line_)) {
      if (file_.bad())
        throw PackingError(fmt::format("{} cannot be read to its end", path_.string()));
      return std::nullopt;
    }
    ++number_;
    constexpr std::string_view blanks = " \t\r,";
    std::string_view rest = std::string_view(line_).substr(0, line_.find('#'));
    Words words;
    for (;;) {
      const auto begin = rest.find_first_not_of(blanks);
      if (begin == std::string_view::npos)
        return words;
      rest.remove_prefix(begin);
      const auto length = std::min(rest.find_first_of(blanks), rest.size());
      words.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
  }
  /// The same, without lines that have no word.
  std::optional<Words> next_words() {
    auto words = next();
    while (words && words->empty())
      words = next();
    return words;
  }
  Words must_follow(const char* what) {
    auto words = next_words();
    if (!words)
      throw PackingError(fmt::format("{} ends where {} should follow", path_.string(), what));
    return *words;
  }
  const std::string& line() const { return line_; }

  [[noreturn]] void fail(const std::string& sentence) const {
    throw PackingError(fmt::format("{}:{}: {}", path_.string(), number_, sentence));
  }
  double number(std::string_view word) const {
    if (word.starts_with('+'))
      word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
      fail(fmt::format("\"{}\" is not a finite number", word));
    return value;
  }
  double radius(std::string_view word) const {
    const double value = number(word);
    if (!(value > 0.0))
      fail(fmt::format("the radius {} m must be positive", value));
    return value;
  }
  std::size_t count(std::string_view word) const {
    const double value = number(word);
    if (!(value >= 0.0) || value != std::floor(value) || value > 4e9)
      fail(fmt::format("\"{}\" is not a number of particles", word));
    return static_cast<std::size_t>(value);
  }

private:
  std::filesystem::path path_;
  std::ifstream file_;
  std::string line_;
  std::size_t number_ = 0;
};

/// What a file holds. Lines of x y r have no z.
struct Content {
  std::vector<Point> points; // m
  std::vector<double> radii; // m
  bool is_plane = false;
};

Content read_lines(Lines& lines, std::optional<int> dim) {
  Content content;
  std::size_t columns = dim ? static_cast<std::size_t>(*dim) + 1 : 0; // 0: as in the first line
  bool may_have_more = false; // columns after the radius, as YADE's #format x_y_z_r_matId
  while (auto words = lines.next()) {
    if (lines.line().starts_with("#format x_y_z_r")) {
      columns = 4;
      may_have_more = true;
    }
    if (words->empty())
      continue;
    if (columns == 0)
      columns = words->size() == 3 ? 3 : 4;
    if (words->size() < columns || (words->size() > columns && !may_have_more))
      lines.fail(fmt::format("a line must hold {} values, {}, but this one holds {}", columns,
                             columns == 3 ? "x y r" : "x y z r", words->size()));
    Point point{};
    for (std::size_t a = 0; a + 1 < columns; ++a)
      point[a] = lines.number((*words)[a]);
    content.points.push_back(point);
    content.radii.push_back(lines.radius((*words)[columns - 1]));
  }
  content.is_plane = columns == 3;
  return content;
}

/// Numbers that go on over as many lines as they like.
std::vector<double> read_numbers(Lines& lines, std::size_t count, const char* what) {
  std::vector<double> numbers;
  while (numbers.size() < count)
    for (const std::string_view word : lines.must_follow(what))
      numbers.push_back(lines.number(word));
  if (numbers.size() > count)
    lines.fail(
        fmt::format("{} end here with {} numbers instead of {}", what, numbers.size(), count));
  return numbers;
}

Content read_vtk(Lines& lines) {
  lines.next(); // the title
  if (const Words kind = lines.must_follow("ASCII"); kind.front() != "ASCII")
    lines.fail(fmt::format("legacy VTK must be ASCII, not {}", kind.front()));
  Content content;
  bool is_point_data = false;
  while (const auto words = lines.next_words()) {
    const std::string_view key = words->front();
    if (key == "POINTS" && words->size() == 3) {
      const std::size_t count = lines.count((*words)[1]);
      const std::vector<double> x = read_numbers(lines, 3 * count, "coordinates");
      for (std::size_t i = 0; i < count; ++i)
        content.points.push_back({x[3 * i], x[3 * i + 1], x[3 * i + 2]});
    } else if (key == "POINT_DATA" || key == "CELL_DATA") {
      is_point_data = key == "POINT_DATA";
    } else if (is_point_data && key == "SCALARS" && words->size() > 1 &&
               ((*words)[1] == "radius" || (*words)[1] == "Radius")) {
      lines.must_follow("LOOKUP_TABLE");
      content.radii = read_numbers(lines, content.points.size(), "radii");
      for (const double radius : content.radii)
        if (!(radius > 0.0))
          lines.fail(fmt::format("the radius {} m must be positive", radius));
    }
  }
  if (content.radii.size() != content.points.size())
    lines.fail("the points have no scalar \"radius\"");
  return content;
}

Content read_moment(Lines& lines, std::size_t count, const Words& columns) {
  const auto column = [&](std::string_view name) {
    const auto found = std::find(columns.begin(), columns.end(), name);
    if (found == columns.end())
      lines.fail(fmt::format("the atoms have no column \"{}\"", name));
    return static_cast<std::size_t>(found - columns.begin()) - 2; // after ITEM: ATOMS
  };
  const std::array<std::size_t, 4> wanted = {column("x"), column("y"), column("z"),
                                             column("radius")};
  const std::size_t id = column("id"), width = columns.size() - 2;
  std::vector<std::pair<double, std::array<double, 4>>> atoms;
  for (std::size_t i = 0; i < count; ++i) {
    const Words words = lines.must_follow("an atom");
    if (words.size() != width)
      lines.fail(
          fmt::format("an atom must have {} values, but this one has {}", width, words.size()));
    auto& [key, values] = atoms.emplace_back(lines.number(words[id]), std::array<double, 4>{});
    for (std::size_t k = 0; k < 3; ++k)
      values[k] = lines.number(words[wanted[k]]);
    values[3] = lines.radius(words[wanted[3]]);
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

Content read_dump(Lines& lines) {
  Content content;
  std::size_t count = 0;
  for (auto words = std::optional<Words>(Words{"ITEM:", "TIMESTEP"}); words;
       words = lines.next_words()) {
    if (words->size() < 2 || words->front() != "ITEM:")
      continue; // a value of an item that does not matter
    if ((*words)[1] == "NUMBER")
      count = lines.count(lines.must_follow("the number of atoms").front());
    else if ((*words)[1] == "ATOMS") {
      const std::string header = lines.line(); // the words point into the line, which changes
      Words columns;
      for (std::size_t begin = 0; begin < header.size();) {
        const auto end = std::min(header.find_first_of(" \t\r", begin), header.size());
        if (end > begin)
          columns.push_back(std::string_view(header).substr(begin, end - begin));
        begin = end + 1;
      }
      content = read_moment(lines, count, columns);
    }
  }
  return content;
}

Content read_content(const std::filesystem::path& path, std::optional<int> dim) {
  Lines lines(path);
  std::ifstream file(path);
  std::string first;
  std::getline(file, first);
  if (first.starts_with("# vtk DataFile"))
    return lines.next(), read_vtk(lines);
  if (first.starts_with("ITEM:"))
    return lines.next(), read_dump(lines);
  return read_lines(lines, first.starts_with("#format") ? std::nullopt : dim);
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
