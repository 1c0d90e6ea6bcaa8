// A whole run in one process: the participants are threads, their frames go through memory. The
// results have the bits of a run with processes.
#include "common/config/case_file.hpp"
#include "coupler/broker/broker.hpp"
#include "coupler/participant/participant.hpp"
#include "dem_core/program/dem_participant.hpp"
#include "fem_core/program/fem_participant.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

namespace kerf {
namespace {

namespace fs = std::filesystem;

/// Participants as threads of this process.
class ThreadSupervisor final : public coupler::Supervisor {
public:
  explicit ThreadSupervisor(const nlohmann::json& participants) : participants_(participants) {}

  void start(const coupler::Participant::Invitation& invitation) override {
    const bool particles = participants_.at(invitation.name).at("kind") == "dem";
    threads_.emplace_back([this, particles, mine = invitation]() mutable {
      try {
        mine.program = "thread";
        coupler::Participant participant(mine);
        particles ? dem::run_dem(participant) : fem::run_fem(participant);
      } catch (const std::exception& error) {
        const std::lock_guard lock(mutex_);
        errors_[mine.name] = error.what();
      }
    });
  }
  void check() override {
    const std::lock_guard lock(mutex_);
    for (const auto& [name, what] : errors_)
      throw coupler::ParticipantLost(name, 0, "threw: " + what);
  }
  void release(const std::string&) override {}

private:
  const nlohmann::json& participants_;
  std::mutex mutex_;
  std::map<std::string, std::string> errors_;
  std::vector<std::jthread> threads_; // joined first
};

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::map<std::string, std::string> results(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const char* part : {"history", "frames"})
    for (const auto& entry : fs::directory_iterator(folder / part))
      files[entry.path().filename()] = content(entry.path());
  return files;
}

class Loopback : public testing::TestWithParam<const char*> {};

TEST_P(Loopback, a_run_has_the_bits_of_a_run_with_processes) {
  const fs::path base = fs::path(testing::TempDir()) / (std::string("kerf-loopback-") + GetParam());
  fs::remove_all(base);
  fs::create_directories(base / "threads" / "history");
  fs::create_directories(base / "threads" / "logs");
  const fs::path file = fs::path(KERF_CONFIGS) / GetParam();

  const CaseFile case_file = CaseFile::read(file);
  {
    ThreadSupervisor supervisor(case_file.settings().at("participants"));
    coupler::Broker broker({.settings = case_file.settings(),
                            .run_folder = base / "threads",
                            .plan_only = false,
                            .transport = "loopback",
                            .progress = {}},
                           supervisor);
    broker.run();
  }
  const std::string command = KERF_PROGRAMS "/kerf run " + file.string() + " --out " +
                              (base / "processes").string() + " > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);

  const auto here = results(base / "threads"), there = results(base / "processes");
  EXPECT_GT(here.size(), 10u);
  EXPECT_TRUE(here == there);
  for (const auto& [name, bytes] : here)
    EXPECT_TRUE(there.contains(name) && there.at(name) == bytes) << name;
  fs::remove_all(base);
}

INSTANTIATE_TEST_SUITE_P(Cases, Loopback, testing::Values("wave_chain.toml", "wave_bar.toml"),
                         [](const auto& parameter) {
                           return fs::path(parameter.param).stem().string();
                         });

} // namespace
} // namespace kerf
