#include "common/history.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace kerf {
namespace {

const std::string units_mark = "# units: ";

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    parts.emplace_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// @throws std::runtime_error when the text is not a number
double to_number(const std::string& text, const std::filesystem::path& path, std::size_t line) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (result.ec != std::errc() || result.ptr != end)
    throw std::runtime_error(
        fmt::format("{}:{}: \"{}\" is not a number", path.string(), line, text));
  return number;
}

} // namespace

void add_axes(std::vector<Column>& columns, const std::string& name, const std::string& unit,
              std::string_view axes) {
  for (const char axis : axes)
    columns.push_back({name + "_" + axis, unit});
}

History::History(std::filesystem::path path, std::vector<Column> columns, std::uint64_t first_step)
    : path_(std::move(path)), num_columns_(columns.size()) {
  std::string units, names;
  for (const Column& column : columns) {
    if ((column.name + column.unit).find_first_of(",\"\r\n") != std::string::npos)
      throw std::invalid_argument(fmt::format("a column cannot be named \"{}\" with unit \"{}\"",
                                              column.name, column.unit));
    units += (units.empty() ? "" : ",") + column.unit;
    names += (names.empty() ? "" : ",") + column.name;
  }
  if (path_.has_parent_path())
    std::filesystem::create_directories(path_.parent_path());
  const std::string header = units_mark + units + "\n" + names + "\n";
  if (first_step != 0)
    cut(header, first_step);
  file_ = ::open(path_.c_str(),
                 O_WRONLY | O_APPEND | O_CLOEXEC | (first_step == 0 ? O_CREAT | O_TRUNC : 0), 0644);
  if (file_ < 0)
    throw std::runtime_error(
        fmt::format("cannot write {}: {}", path_.string(), std::strerror(errno)));
  if (first_step == 0)
    write_line(header);
}

/// Leaves the rows before a step; a last line without its end goes, too.
void History::cut(const std::string& header, std::uint64_t first_step) {
  std::ifstream file(path_, std::ios::binary);
  std::string start(header.size(), '\0');
  if (!file.read(start.data(), static_cast<std::streamsize>(start.size())) || start != header)
    throw std::runtime_error(
        fmt::format("cannot go on with {}: it is missing or has other columns", path_.string()));
  std::uintmax_t size = header.size();
  std::string line;
  for (std::size_t number = 3; std::getline(file, line) && !file.eof(); ++number) {
    if (to_number(line.substr(0, line.find(',')), path_, number) >= static_cast<double>(first_step))
      break;
    size += line.size() + 1;
  }
  std::filesystem::resize_file(path_, size);
}

History::~History() {
  if (file_ >= 0)
    ::close(file_);
}

History::History(History&& other) noexcept
    : path_(std::move(other.path_)), num_columns_(other.num_columns_),
      file_(std::exchange(other.file_, -1)) {}

History& History::operator=(History&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(num_columns_, other.num_columns_);
  std::swap(file_, other.file_);
  return *this;
}

void History::append(std::span<const double> row) {
  if (row.size() != num_columns_)
    throw std::invalid_argument(fmt::format("{} has {} columns, but the row has {} values",
                                            path_.string(), num_columns_, row.size()));
  std::string line;
  for (const double value : row) {
    char digits[32];
    line.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    line += ',';
  }
  line.back() = '\n';
  write_line(line);
}

void History::write_line(const std::string& line) {
  ssize_t written = -1;
  do
    written = ::write(file_, line.data(), line.size());
  while (written < 0 && errno == EINTR);
  if (written != static_cast<ssize_t>(line.size()))
    throw std::runtime_error(fmt::format("cannot write {}: {}", path_.string(),
                                         written < 0 ? std::strerror(errno) : "the disk is full"));
}

bool HistoryTable::has(std::string_view name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<double> HistoryTable::column(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw std::invalid_argument(
        fmt::format("there is no column \"{}\"; there are {}", name, fmt::join(names, ", ")));
  const auto index = static_cast<std::size_t>(found - names.begin());
  std::vector<double> values;
  values.reserve(rows.size());
  for (const std::vector<double>& row : rows)
    values.push_back(row[index]);
  return values;
}

HistoryTable read_history(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw std::runtime_error("cannot read " + path.string());
  HistoryTable table;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line) && !file.eof(); ++number) {
    if (number == 1 && !line.starts_with(units_mark))
      throw std::runtime_error(path.string() + " is not a history: it has no line of units");
    const std::vector<std::string> parts =
        split(number == 1 ? line.substr(units_mark.size()) : line);
    if (number > 1 && parts.size() != table.units.size())
      throw std::runtime_error(fmt::format("{}:{}: {} values stand where {} should", path.string(),
                                           number, parts.size(), table.units.size()));
    if (number == 1)
      table.units = parts;
    else if (number == 2)
      table.names = parts;
    else
      std::transform(parts.begin(), parts.end(), std::back_inserter(table.rows.emplace_back()),
                     [&](const std::string& part) { return to_number(part, path, number); });
  }
  if (table.names.empty())
    throw std::runtime_error(path.string() + " is not a history: it has no names of columns");
  return table;
}

} // namespace kerf
