// Time series come back as they were written, to the last bit.
#include "common/history.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace kerf {
namespace {

class HistoryFile : public testing::Test {
protected:
  HistoryFile()
      : folder_(std::filesystem::temp_directory_path() /
                ("kerf_history_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    std::filesystem::remove_all(folder_);
  }
  ~HistoryFile() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  std::filesystem::path path_ = folder_ / "history" / "rock.csv";
  std::vector<Column> columns_ = {{"step", "1"}, {"time", "s"}, {"kinetic_energy", "J"}};
};

TEST_F(HistoryFile, comes_back_to_the_same_bits) {
  const std::vector<std::vector<double>> rows = {
      {0.0, 0.1, 1.0 / 3.0},
      {1.0, 1e-300, -std::numeric_limits<double>::infinity()},
      {2.0, std::numeric_limits<double>::denorm_min(), std::nextafter(1.0, 2.0)}};
  History history(path_, columns_);
  for (const auto& row : rows)
    history.append(row);
  const HistoryTable table = read_history(path_); // while the writer still has it open
  EXPECT_EQ(table.rows, rows);
  EXPECT_EQ(table.names, (std::vector<std::string>{"step", "time", "kinetic_energy"}));
  EXPECT_EQ(table.units, (std::vector<std::string>{"1", "s", "J"}));
  EXPECT_EQ(table.column("time")[1], 1e-300);
  EXPECT_THROW(table.column("tmie"), std::invalid_argument);
}

TEST_F(HistoryFile, keeps_what_is_not_a_number) {
  History history(path_, columns_);
  history.append(std::vector{0.0, std::nan(""), 0.0});
  EXPECT_TRUE(std::isnan(read_history(path_).column("time")[0]));
}

TEST_F(HistoryFile, begins_with_units_and_names) {
  History history(path_, columns_);
  history.append(std::vector{3.0, 0.5, 1e22});
  std::ifstream file(path_);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text, "# units: 1,s,J\nstep,time,kinetic_energy\n3,0.5,1e+22\n");
}

TEST_F(HistoryFile, is_read_without_the_half_line_of_a_killed_writer) {
  History(path_, columns_).append(std::vector{1.0, 2.0, 3.0});
  std::ofstream(path_, std::ios::app) << "2,3.";
  EXPECT_EQ(read_history(path_).rows.size(), 1U);
}

TEST_F(HistoryFile, refuses_rows_of_another_length_and_names_with_commas) {
  History history(path_, columns_);
  EXPECT_THROW(history.append(std::vector{1.0}), std::invalid_argument);
  EXPECT_TRUE(read_history(path_).rows.empty());
  EXPECT_THROW(History(folder_ / "b.csv", {{"a,b", "1"}}), std::invalid_argument);
}

TEST_F(HistoryFile, is_refused_when_it_is_something_else) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "other.csv") << "a,b\n1,2\n";
  EXPECT_THROW(read_history(folder_ / "other.csv"), std::runtime_error);
  EXPECT_THROW(read_history(folder_ / "none.csv"), std::runtime_error);
}

} // namespace
} // namespace kerf
