// Checkpoint files come back whole or not at all; histories and frames are cut where they should.
#include "common/checkpoint.hpp"

#include "common/history.hpp"
#include "common/results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace kerf {

struct Item {
  std::uint32_t id = 0;
  double value = 0.0;
  std::vector<double> more;
};
template <class Visit> void visit_parts(Item& item, Visit& visit) {
  auto& [id, value, more] = item;
  visit("id", id);
  visit("value", value);
  visit("more", more);
}

namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

class CheckpointFile : public testing::Test {
protected:
  CheckpointFile()
      : folder_(fs::temp_directory_path() /
                ("kerf_checkpoint_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CheckpointFile() override { fs::remove_all(folder_); }

  std::string refusal(const std::string& writer = "test 1") const {
    try {
      read_checkpoint(file_, writer);
      return "";
    } catch (const CheckpointError& error) {
      return error.what();
    }
  }

  fs::path folder_, file_ = folder_ / "rock.h5";
  Checkpoint checkpoint_{
      "test 1",
      7,
      {{"a.real",
        std::vector<double>{-0.0, 1.0 / 3.0, std::numeric_limits<double>::denorm_min(), INFINITY}},
       {"b", std::vector<std::uint64_t>{UINT64_MAX, 0}},
       {"c", std::vector<std::uint32_t>{}},
       {"d", std::vector<std::uint8_t>{255}}}};
};

TEST_F(CheckpointFile, comes_back_to_the_same_bits_and_types) {
  write_checkpoint(file_, checkpoint_);
  const Checkpoint back = read_checkpoint(file_, "test 1");
  EXPECT_EQ(back.step, 7u);
  EXPECT_EQ(back.state, checkpoint_.state);
  EXPECT_TRUE(std::signbit(std::get<0>(back.state.at("a.real"))[0]));
  const std::string first = content(file_);
  write_checkpoint(file_, checkpoint_);
  EXPECT_EQ(content(file_), first);
}

TEST_F(CheckpointFile, is_refused_when_it_is_cut_changed_missing_or_of_another_program) {
  EXPECT_NE(refusal().find("there is no checkpoint"), std::string::npos);
  write_checkpoint(file_, checkpoint_);
  EXPECT_EQ(refusal(), "");
  EXPECT_NE(refusal("test 2").find("was written by test 1, and this is test 2"), std::string::npos);
  const std::string whole = content(file_);
  for (const std::size_t size : {std::size_t{0}, std::size_t{50}, whole.size() - 1}) {
    std::ofstream(file_, std::ios::binary) << whole.substr(0, size);
    EXPECT_NE(refusal().find("truncated, changed"), std::string::npos) << size;
  }
  std::string changed = whole;
  const double third = 1.0 / 3.0;
  const std::size_t at = whole.find(std::string(reinterpret_cast<const char*>(&third), 8));
  ASSERT_NE(at, std::string::npos);
  changed[at] = static_cast<char>(changed[at] ^ 1);
  std::ofstream(file_, std::ios::binary) << changed;
  EXPECT_NE(refusal().find("truncated, changed"), std::string::npos);
}

TEST_F(CheckpointFile, is_no_checkpoint_of_the_run_before_its_record_is_there) {
  for (const std::uint64_t step : {10u, 20u, 30u})
    write_checkpoint(checkpoint_folder(folder_, step) / "rock.h5", checkpoint_);
  EXPECT_TRUE(list_checkpoints(folder_).empty());
  for (const std::uint64_t step : {10u, 20u})
    std::ofstream(checkpoint_folder(folder_, step) / "checkpoint.json") << "{}";
  EXPECT_EQ(list_checkpoints(folder_), (std::vector<std::uint64_t>{10, 20}));
  keep_checkpoints(folder_, 1);
  EXPECT_EQ(list_checkpoints(folder_), (std::vector<std::uint64_t>{20}));
  EXPECT_FALSE(fs::exists(checkpoint_folder(folder_, 10)));
  EXPECT_TRUE(fs::exists(checkpoint_folder(folder_, 30))); // is being written
  remove_checkpoints_after(folder_, 20);
  EXPECT_FALSE(fs::exists(checkpoint_folder(folder_, 30)));
}

TEST(StateOfParts, goes_there_and_back_with_lists_in_lists) {
  std::vector<Item> items = {{1, 0.5, {1.0, 2.0}}, {2, -0.0, {}}, {3, 1e300, {3.0}}};
  State state;
  StateWriter writer(state);
  writer("items", items);
  EXPECT_EQ(std::get<std::vector<double>>(state.at("items.more")), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(std::get<std::vector<std::uint64_t>>(state.at("items.more.size")),
            (std::vector<std::uint64_t>{2, 0, 1}));

  std::vector<Item> back;
  StateReader reader(state);
  reader("items", back);
  reader.finish();
  ASSERT_EQ(back.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(back[k].id, items[k].id);
    EXPECT_EQ(std::signbit(back[k].value), std::signbit(items[k].value));
    EXPECT_EQ(back[k].value, items[k].value);
    EXPECT_EQ(back[k].more, items[k].more);
  }
}

TEST(StateOfParts, is_refused_when_something_is_missing_or_left_over) {
  std::vector<double> values = {1.0, 2.0};
  State state;
  StateWriter writer(state);
  writer("values", values);
  {
    StateReader reader(state);
    EXPECT_THROW(reader("other", values), std::invalid_argument);
    EXPECT_THROW(reader.finish(), std::invalid_argument); // nothing was taken
  }
  std::get<std::vector<double>>(state["values"]).pop_back();
  StateReader reader(state);
  EXPECT_THROW(reader("values", values), std::invalid_argument);
}

TEST_F(CheckpointFile, histories_and_frames_are_cut_back_to_its_step) {
  const std::vector<Column> columns = {{"step", "1"}, {"time", "s"}};
  const std::vector<double> x = {0.0, 0.0, 1.0, 0.0};
  const std::vector<Grid> grids = {{.name = "points",
                                    .positions = x,
                                    .points_of = {},
                                    .cells = Cells::points,
                                    .connectivity = {},
                                    .point_fields = {},
                                    .cell_fields = {}}};
  const auto write = [&](const fs::path& folder, std::uint64_t first, std::uint64_t last) {
    History history(folder / "rock.csv", columns, first);
    FrameWriter frames(folder, "rock", 2, first);
    for (std::uint64_t step = first; step < last; ++step) {
      history.append(
          std::vector<double>{static_cast<double>(step), 0.1 * static_cast<double>(step)});
      if (step % 3 == 0)
        frames.write(step, 0.1 * static_cast<double>(step), grids);
    }
  };
  write(folder_ / "whole", 0, 20);
  write(folder_ / "cut", 0, 17);
  std::ofstream(folder_ / "cut" / "rock.csv", std::ios::app) << "17,1."; // killed in a row
  write(folder_ / "cut", 11, 20);
  for (const char* file : {"rock.csv", "rock.xdmf", "frames/rock_000000018.h5"})
    EXPECT_EQ(content(folder_ / "cut" / file), content(folder_ / "whole" / file)) << file;

  { FrameWriter frames(folder_ / "cut", "rock", 2, 4); }
  const auto left = list_frames(folder_ / "cut", "rock");
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left.back().step, 3u);
  EXPECT_EQ(content(folder_ / "cut" / "rock.xdmf").find("step 6"), std::string::npos);
  const std::vector<Column> other = {{"step", "1"}, {"energy", "J"}};
  EXPECT_THROW(History(folder_ / "cut" / "rock.csv", other, 5), std::runtime_error);
  EXPECT_THROW(History(folder_ / "nowhere.csv", columns, 5), std::runtime_error);
}

} // namespace
} // namespace kerf
