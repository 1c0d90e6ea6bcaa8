// Frames come back as they were written; nothing half-written has a final name.
#include "common/results.hpp"

#include "common/atomic_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <thread>

namespace kerf {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Frames : public testing::Test {
protected:
  Frames()
      : folder_(std::filesystem::temp_directory_path() /
                ("kerf_frames_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    std::filesystem::remove_all(folder_);
  }
  ~Frames() override { std::filesystem::remove_all(folder_); }

  /// Three particles, the two contacts between them.
  std::vector<Grid> grids() const {
    Grid particles{.name = "particles",
                   .positions = position_,
                   .points_of = {},
                   .connectivity = {},
                   .point_fields = {},
                   .cell_fields = {}};
    particles.point_fields = {{"id", 1, std::span(id_)}, {"velocity", 2, std::span(velocity_)}};
    Grid contacts{.name = "contacts",
                  .positions = {},
                  .points_of = "particles",
                  .cells = Cells::segments,
                  .connectivity = pairs_,
                  .point_fields = {},
                  .cell_fields = {}};
    contacts.cell_fields = {{"normal_force", 1, std::span(force_)}};
    return {particles, contacts};
  }

  std::filesystem::path folder_;
  const std::vector<double> position_ = {0.0, 0.0, 1.0, 0.1, 2.0, 0.2};
  const std::vector<double> velocity_ = {1.0, 2.0, 3.0, 4.0, 5.0, 1.0 / 3.0};
  const std::vector<std::int64_t> id_ = {7, 8, 1'000'000'000'000};
  const std::vector<std::uint32_t> pairs_ = {0, 1, 1, 2};
  const std::vector<double> force_ = {-1.5, 2.5};
};

TEST_F(Frames, come_back_to_the_same_bits_with_vectors_of_three) {
  FrameWriter(folder_, "rock", 2).write(12, 0.1, grids());
  const auto files = list_frames(folder_, "rock");
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].step, 12U);
  EXPECT_EQ(files[0].path, folder_ / "frames/rock_000000012.h5");
  const Frame frame = read_frame(files[0].path);
  EXPECT_EQ(frame.step, 12U);
  EXPECT_EQ(frame.time, 0.1);
  EXPECT_EQ(frame.at("particles/position").reals(),
            (std::vector<double>{0.0, 0.0, 0.0, 1.0, 0.1, 0.0, 2.0, 0.2, 0.0}));
  EXPECT_EQ(frame.at("particles/velocity").columns, 3U);
  EXPECT_EQ(frame.at("particles/velocity").reals()[7], 1.0 / 3.0);
  EXPECT_EQ(frame.at("particles/id").integers(), id_);
  EXPECT_EQ(frame.at("contacts/cells").integers(), (std::vector<std::int64_t>{0, 1, 1, 2}));
  EXPECT_EQ(frame.at("contacts/cells").rows, 2U);
  EXPECT_EQ(frame.at("contacts/normal_force").reals(), force_);
  EXPECT_FALSE(frame.has("contacts/position"));
  EXPECT_THROW(frame.at("contacts/force"), std::invalid_argument);
  EXPECT_THROW(frame.at("particles/id").reals(), std::invalid_argument);
}

TEST_F(Frames, of_the_same_data_are_the_same_bytes) {
  FrameWriter(folder_ / "a", "rock", 2).write(5, 0.25, grids());
  std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // times of HDF5 are whole seconds
  FrameWriter(folder_ / "b", "rock", 2).write(5, 0.25, grids());
  const std::string first = content(folder_ / "a/frames/rock_000000005.h5");
  EXPECT_FALSE(first.empty());
  EXPECT_TRUE(first == content(folder_ / "b/frames/rock_000000005.h5"));
  EXPECT_EQ(content(folder_ / "a/rock.xdmf"), content(folder_ / "b/rock.xdmf"));
}

TEST_F(Frames, are_all_in_the_index_in_the_order_of_their_steps) {
  FrameWriter writer(folder_, "rock", 2);
  for (const std::uint64_t step : {0U, 10U, 1'234'567'890U})
    writer.write(step, 1e-6 * static_cast<double>(step), grids());
  FrameWriter(folder_, "rock_2", 2).write(3, 0.0, grids()); // another participant
  const std::string index = content(folder_ / "rock.xdmf");
  const std::size_t first = index.find("frames/rock_000000000.h5:/particles/position"),
                    second = index.find("frames/rock_000000010.h5:/particles/position"),
                    third = index.find("frames/rock_1234567890.h5:/particles/position");
  EXPECT_LT(first, second);
  EXPECT_LT(second, third);
  EXPECT_NE(third, std::string::npos);
  EXPECT_EQ(list_frames(folder_, "rock").size(), 3U);
  EXPECT_EQ(list_frames(folder_, "rock_2").size(), 1U);
  EXPECT_TRUE(list_frames(folder_ / "nowhere", "rock").empty());
}

TEST_F(Frames, may_have_grids_without_cells) {
  std::vector<Grid> bare = grids();
  bare[1].connectivity = {};
  bare[1].cell_fields[0].data = std::span<const double>();
  FrameWriter(folder_, "rock", 2).write(0, 0.0, bare);
  const Frame frame = read_frame(list_frames(folder_, "rock")[0].path);
  EXPECT_EQ(frame.at("contacts/normal_force").rows, 0U);
  EXPECT_EQ(frame.at("contacts/cells").columns, 2U);
  EXPECT_EQ(content(folder_ / "rock.xdmf").find("contacts"), std::string::npos);
}

TEST_F(Frames, that_do_not_fit_leave_no_file) {
  FrameWriter writer(folder_, "rock", 2);
  std::vector<Grid> wrong = grids();
  wrong[0].point_fields[1].components = 3;
  EXPECT_THROW(writer.write(0, 0.0, wrong), std::invalid_argument);
  wrong = grids();
  wrong[1].points_of = "nodes";
  EXPECT_THROW(writer.write(0, 0.0, wrong), std::invalid_argument);
  wrong = grids();
  const std::vector<std::uint32_t> outside = {0, 3};
  wrong[1].connectivity = outside;
  EXPECT_THROW(writer.write(0, 0.0, wrong), std::invalid_argument);
  wrong = grids();
  wrong[0].point_fields[0].name = "velocity"; // found only while the file is being written
  EXPECT_THROW(writer.write(0, 0.0, wrong), std::runtime_error);
  EXPECT_TRUE(list_frames(folder_, "rock").empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "frames"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "rock.xdmf"));
}

TEST_F(Frames, may_be_written_by_several_threads_at_once) {
  const auto run = [&](const std::string& name) {
    FrameWriter writer(folder_, name, 2);
    for (std::uint64_t step = 0; step < 20; ++step)
      writer.write(step, 0.0, grids());
  };
  std::thread other(run, "far");
  run("rock");
  other.join();
  EXPECT_EQ(list_frames(folder_, "rock").size(), 20U);
  EXPECT_EQ(list_frames(folder_, "far").size(), 20U);
}

TEST_F(Frames, that_are_cut_short_are_refused) {
  FrameWriter(folder_, "rock", 2).write(0, 0.0, grids());
  const auto path = list_frames(folder_, "rock")[0].path;
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(read_frame(path), std::runtime_error);
  EXPECT_THROW(read_frame(folder_ / "none.h5"), std::runtime_error);
}

TEST_F(Frames, replace_whole_files_only) {
  const auto path = folder_ / "text" / "a.txt";
  write_text(path, "first");
  const auto fails = [](const std::filesystem::path& temporary) {
    std::ofstream(temporary) << "half";
    throw std::runtime_error("the disk is full");
  };
  EXPECT_THROW(write_atomically(path, fails), std::runtime_error);
  EXPECT_EQ(content(path), "first");
  write_text(path, "second");
  EXPECT_EQ(content(path), "second");
  const auto entries = std::filesystem::directory_iterator(path.parent_path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

} // namespace
} // namespace kerf
