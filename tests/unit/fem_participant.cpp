// kerf-fem's loop against a scripted broker: what it declares, writes and refuses.
#include "fem_core/program/fem_participant.hpp"
#include "common/history.hpp"
#include "common/results.hpp"
#include "tests/unit/mini_broker.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>

namespace kerf::fem {
namespace {

using namespace coupler;
namespace fs = std::filesystem;

/// A bar of 8 x 2 elements that is pushed at its left end.
constexpr const char* settings = R"({
  "kind": "fem", "solver": "kerf-fem", "command": null, "threads": 1,
  "mesh": {"type": "box", "origin": [0.0, 0.0], "size": [8e-3, 2e-3], "count": [8, 2]},
  "material": {"model": "linear_elastic", "density": 2500.0, "young_modulus": 1e10,
               "poisson_ratio": 0.25, "C11": null, "C12": null},
  "boundary": [{"tag": "left", "box": null, "components": ["x"], "motion": "hann",
                "velocity": null, "amplitude": [1e-8, 0.0], "duration": 2e-6}],
  "initial": []})";

class FemParticipant : public testing::Test {
protected:
  void SetUp() override {
    folder =
        fs::path(testing::TempDir()) /
        ("kerf_fem_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override {
    if (end.valid()) { // the test has failed: nobody waits for the participant
      broker.say(Stop{"the test has ended"});
      end.wait();
    }
    fs::remove_all(folder);
  }

  /// Starts the participant, and answers until it has declared itself.
  void join(const std::string& table, bool plan_only = false) {
    end = std::async(std::launch::async, [this] {
      Participant participant(broker.invitation());
      try {
        return run_fem(participant);
      } catch (const SettingsError& error) {
        participant.fail(ErrorKind::bad_input, error.key(), error.what());
        throw;
      } catch (const std::exception& error) {
        participant.fail(ErrorKind::failed, "", error.what());
        throw;
      }
    });
    const Hello hello = broker.await<Hello>(message::hello);
    broker.say(Assignment{hello.name, table, R"({"dimension": 2, "periodic": {}})", folder,
                          plan_only, getpid()});
  }

  fs::path folder;
  MiniBroker broker;
  std::future<int> end; // of run_fem()
};

TEST_F(FemParticipant, writes_a_history_and_frames_that_open_without_the_program) {
  join(settings);
  const auto declaration = broker.await<Declaration>(message::declaration);
  EXPECT_EQ(declaration.dimension, 2);
  EXPECT_EQ(declaration.ids.size(), 27u);
  EXPECT_EQ(declaration.nodes_per_element, 4);
  EXPECT_EQ(declaration.boundary.at("left").size(), 4u);
  broker.say(Plan{});
  const auto limits = broker.await<Limits>(message::limits);
  EXPECT_TRUE(limits.limited_by.starts_with("element ")); // all are equal: rounding chooses
  // 2 (lambda + mu) per element of unit shape: 8 (lambda + mu) / (rho h²), see the bound's own test
  EXPECT_NEAR(limits.largest_omega2, 8.0 * 8e9 / 2500.0 / 1e-6, 1e-9 * limits.largest_omega2);
  broker.say(Schedule{.time_step = 1e-7, .steps = 25, .history_every = 10, .frame_every = 20});
  const auto finished = broker.await<Finished>(message::finished);
  EXPECT_EQ(finished.steps, 25u);
  EXPECT_NE(finished.summary.find("\"output\""), std::string::npos);
  broker.say_goodbye();
  EXPECT_EQ(end.get(), 0);

  const HistoryTable history = read_history(folder / "history" / "rock.csv");
  EXPECT_EQ(history.column("step"), (std::vector<double>{0, 10, 20, 24}));
  const auto kinetic = history.column("kinetic_energy"), elastic = history.column("elastic_energy"),
             work = history.column("external_work");
  EXPECT_GT(work[1], 0.0);
  for (std::size_t k = 0; k < 4; ++k) // linear: energy is work, to round-off
    EXPECT_NEAR(kinetic[k] + elastic[k], work[k], 1e-12 * work[1]);

  const auto frames = list_frames(folder, "rock");
  ASSERT_EQ(frames.size(), 3u); // 0, 20 and the end
  EXPECT_EQ(frames[2].step, 25u);
  const Frame frame = read_frame(frames[1].path);
  const auto& u = frame.at("mesh/displacement").reals();
  const auto& energy = frame.at("mesh/elastic_energy").reals();
  EXPECT_NEAR(u[0], 0.0, 1e-22); // the Hann motion ends at step 20; sin² of pi is not quite zero
  double sum = 0.0;
  for (const double e : energy)
    sum += e;
  EXPECT_NEAR(sum, elastic[2], 1e-12 * elastic[2]); // x^20, and the row of t_20
  EXPECT_EQ(frame.at("mesh/stress").columns, 4u);
  EXPECT_EQ(frame.at("mesh/alpha").reals()[5], 1.0);
}

TEST_F(FemParticipant, writes_nothing_when_the_run_is_only_planned) {
  join(settings, true);
  broker.await<Declaration>(message::declaration);
  broker.say(Plan{});
  broker.await<Limits>(message::limits);
  broker.say(Schedule{.time_step = 1e-7, .steps = 0, .history_every = 1, .frame_every = 5});
  broker.await<Finished>(message::finished);
  broker.say_goodbye();
  EXPECT_EQ(end.get(), 0);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(FemParticipant, answers_settings_it_cannot_use_with_their_key) {
  std::string table = settings;
  table.replace(table.find("\"left\""), 6, "\"lfet\"");
  join(table);
  const auto report = broker.await<ErrorReport>(message::error);
  EXPECT_EQ(report.kind, ErrorKind::bad_input);
  EXPECT_EQ(report.key, "boundary[0].tag");
  EXPECT_NE(report.sentence.find("did you mean \"left\"?"), std::string::npos);
  EXPECT_THROW(end.get(), SettingsError);
}

// A step far above the critical one overflows within some hundred steps.
TEST_F(FemParticipant, ends_with_a_node_and_the_time_when_the_motion_is_no_longer_finite) {
  join(settings);
  broker.await<Declaration>(message::declaration);
  broker.say(Plan{});
  broker.await<Limits>(message::limits);
  broker.say(Schedule{.time_step = 1e-6, .steps = 1000, .history_every = 10});
  const auto report = broker.await<ErrorReport>(message::error);
  EXPECT_EQ(report.kind, ErrorKind::failed);
  EXPECT_NE(report.sentence.find(" at t = "), std::string::npos) << report.sentence;
  EXPECT_NE(report.sentence.find(" finite number"), std::string::npos) << report.sentence;
  EXPECT_NE(report.sentence.find("node "), std::string::npos) << report.sentence;
  EXPECT_THROW(end.get(), std::runtime_error);
  for (const auto& row : read_history(folder / "history" / "rock.csv").rows)
    for (const double value : row)
      EXPECT_TRUE(std::isfinite(value));
}

} // namespace
} // namespace kerf::fem
