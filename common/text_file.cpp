#include "common/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace kerf {

namespace {

constexpr std::string_view blanks = " \t\r,";

void split(std::string_view line, std::vector<std::string_view>& words) {
  words.clear();
  for (;;) {
    const auto begin = line.find_first_not_of(blanks);
    if (begin == std::string_view::npos)
      return;
    line.remove_prefix(begin);
    const auto length = std::min(line.find_first_of(blanks), line.size());
    words.push_back(line.substr(0, length));
    line.remove_prefix(length);
  }
}

/// True when the whole word is a value of this type.
template <class Value> bool parse(std::string_view word, Value& value) {
  if (word.starts_with('+'))
    word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

} // namespace

TextFile::TextFile(const std::filesystem::path& path, char comment)
    : path_(path), comment_(comment), file_(path) {
  if (!file_ || std::filesystem::is_directory(path))
    throw FileError(fmt::format("{} cannot be opened", path.string()));
}

bool TextFile::next() {
  while (std::getline(file_, line_)) {
    ++line_number_;
    split(std::string_view(line_).substr(0, line_.find(comment_)), words_);
    if (!words_.empty())
      return true;
  }
  if (file_.bad())
    throw FileError(fmt::format("{} cannot be read to its end", path_.string()));
  words_.clear();
  return false;
}

std::string TextFile::place() const {
  return fmt::format("{}:{}", path_.string(), line_number_);
}

double TextFile::number(std::size_t index) const {
  double value = 0.0;
  if (!parse(word(index), value) || !std::isfinite(value))
    fail(fmt::format("\"{}\" is not a finite number", word(index)));
  return value;
}

std::uint64_t TextFile::count(std::size_t index) const {
  std::uint64_t value = 0;
  if (!parse(word(index), value))
    fail(fmt::format("\"{}\" is not a whole number", word(index)));
  return value;
}

void TextFile::fail(const std::string& sentence) const {
  throw FileError(place() + ": " + sentence);
}

std::string_view TextFile::word(std::size_t index) const {
  if (index >= words_.size())
    fail(fmt::format("the line ends after {} values, but needs {}", words_.size(), index + 1));
  return words_[index];
}

} // namespace kerf
