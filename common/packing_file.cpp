#include "common/packing_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <string>
#include <string_view>

namespace kerf {

namespace {

constexpr std::string_view blanks = " \t\r,";

std::vector<std::string_view> words_of(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  for (;;) {
    const auto begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos)
      return words;
    line.remove_prefix(begin);
    const auto length = std::min(line.find_first_of(blanks), line.size());
    words.push_back(line.substr(0, length));
    line.remove_prefix(length);
  }
}

double number_of(std::string_view word, const std::string& place) {
  if (word.starts_with('+'))
    word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    throw PackingError(fmt::format("{}: \"{}\" is not a finite number", place, word));
  return value;
}

} // namespace

Packing read_packing(const std::filesystem::path& path, int dim) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path))
    throw PackingError(fmt::format("{} cannot be opened", path.string()));

  Packing packing;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const auto words = words_of(line);
    if (words.empty())
      continue;
    const std::string place = fmt::format("{}:{}", path.string(), number);
    if (words.size() != static_cast<std::size_t>(dim) + 1)
      throw PackingError(fmt::format("{}: a line must hold {} values, {}, but this one holds {}",
                                     place, dim + 1, dim == 2 ? "x y r" : "x y z r", words.size()));
    for (int a = 0; a < dim; ++a)
      packing.positions.push_back(number_of(words[static_cast<std::size_t>(a)], place));
    const double radius = number_of(words.back(), place);
    if (!(radius > 0.0))
      throw PackingError(fmt::format("{}: the radius {} m must be positive", place, radius));
    packing.radii.push_back(radius);
  }
  if (file.bad())
    throw PackingError(fmt::format("{} cannot be read to its end", path.string()));
  if (packing.radii.empty())
    throw PackingError(fmt::format("{} holds no particle", path.string()));
  return packing;
}

} // namespace kerf
