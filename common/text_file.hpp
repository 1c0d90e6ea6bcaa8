// Text files read line by line, and errors that name file and line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

/// An input file that cannot be used; what() begins with file:line where there is a line.
class FileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Words between blanks and commas, from one line that is not empty to the next.
class TextFile {
public:
  /// @param comment  what follows it in a line counts for nothing; '\0': there are no comments
  /// @throws FileError when the file cannot be opened
  TextFile(const std::filesystem::path& path, char comment);

  /// Goes to the next line with a word; false at the end.
  /// @throws FileError when the file cannot be read to its end
  bool next();

  const std::string& line() const noexcept { return line_; }
  const std::vector<std::string_view>& words() const noexcept { return words_; }
  /// The first word, or nothing before the first line.
  std::string_view first() const { return words_.empty() ? std::string_view() : words_.front(); }
  std::size_t line_number() const noexcept { return line_number_; } // from 1
  std::string place() const;                                        // file:line

  /// @throws FileError when the line has fewer words, or this one is not a finite number
  double number(std::size_t word) const;
  /// @throws FileError when the line has fewer words, or this one is not a whole number >= 0
  std::uint64_t count(std::size_t word) const;

  /// @throws FileError with the place of this line, always
  [[noreturn]] void fail(const std::string& sentence) const;

private:
  std::string_view word(std::size_t index) const;

  std::filesystem::path path_;
  char comment_;
  std::ifstream file_;
  std::string line_;
  std::size_t line_number_ = 0;
  std::vector<std::string_view> words_; // of line_
};

} // namespace kerf
