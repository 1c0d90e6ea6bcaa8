// Time series of a run: one CSV file, a column per quantity, a row per moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kerf {

struct Column {
  std::string name; // "kinetic_energy"
  std::string unit; // "J"; "1" of a plain number
};

/// "force_x", "force_y": a column for each of these axes, in their order.
void add_axes(std::vector<Column>& columns, const std::string& name, const std::string& unit,
              std::string_view axes);

/// Writes a time series. The first line is "# units: 1,s,J", the second has the names. Every row
/// goes out in one write, so a reader never sees half a row except perhaps the last of a process
/// that was killed. Numbers are the shortest that read back to the same bits.
class History {
public:
  /// Starts the file anew; folders that are missing are made.
  /// @param first_step  other than 0: goes on with the file instead, of which the first column is
  ///                    the step; rows from this step on are cut off
  /// @throws std::runtime_error when the file cannot be written, or is not one to go on with
  /// @throws std::invalid_argument when a name or unit has a comma, a quote or a line break
  History(std::filesystem::path path, std::vector<Column> columns, std::uint64_t first_step = 0);
  ~History();
  History(History&& other) noexcept;
  History& operator=(History&& other) noexcept;

  /// @param row  [num_columns]
  /// @throws std::invalid_argument when the row has another number of values
  /// @throws std::runtime_error when the disk is full or the file is gone
  void append(std::span<const double> row);

private:
  void write_line(const std::string& line);
  void cut(const std::string& header, std::uint64_t first_step);

  std::filesystem::path path_;
  std::size_t num_columns_ = 0;
  int file_ = -1; // descriptor
};

/// A time series that was read back.
struct HistoryTable {
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<std::vector<double>> rows; // [num_rows][num_columns]

  bool has(std::string_view name) const;
  /// [num_rows] values of one column.
  /// @throws std::invalid_argument when there is no such column; names those that there are
  std::vector<double> column(std::string_view name) const;
};

/// Reads what History wrote. A last line without its end is left out: its writer was killed.
/// @throws std::runtime_error when the file cannot be opened or is not such a file
HistoryTable read_history(const std::filesystem::path& path);

} // namespace kerf
