// Participants as child processes, and the signals that end a run.
#pragma once

#include "coupler/broker/launcher.hpp"
#include "coupler/broker/supervisor.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace kerf::coupler {

/// Turns SIGINT, SIGTERM and SIGHUP into Interrupted, thrown by check(), as long as it lives.
class ProcessSupervisor final : public Supervisor {
public:
  /// @param participants  table [participants] of the case
  /// @param programs      folder of kerf-dem, kerf-fem and the adapters
  /// @param logs          existing folder that receives one log for each participant
  ProcessSupervisor(nlohmann::json participants, std::filesystem::path programs,
                    std::filesystem::path logs);
  ~ProcessSupervisor() override;
  ProcessSupervisor(const ProcessSupervisor&) = delete;
  ProcessSupervisor& operator=(const ProcessSupervisor&) = delete;

  void start(const Participant::Invitation& invitation) override;
  void check() override;
  void release(const std::string& name) override { released_.insert(name); }

  /// Ends the children: the patience is how long they may take to end by themselves.
  void stop(std::chrono::milliseconds patience) { launcher_.stop(patience); }

private:
  nlohmann::json participants_;
  std::filesystem::path programs_, logs_;
  Launcher launcher_;
  std::set<std::string> released_;
};

} // namespace kerf::coupler
