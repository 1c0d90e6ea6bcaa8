// The broker of a run: brings the participants together, computes the couplings step by step,
// keeps their books, and ends the run for everybody when one of them fails.
#pragma once

#include "coupler/broker/coupling.hpp"
#include "coupler/broker/supervisor.hpp"
#include "coupler/channel/channel.hpp"
#include "coupler/channel/control.hpp"
#include "coupler/channel/frame_layout.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace kerf::coupler {

/// Why a run could not be done, in one sentence; for bad input what to do instead follows after a
/// line break.
class RunError : public std::runtime_error {
public:
  /// @param key  dotted path in the case for bad input, else empty
  RunError(ErrorKind kind, std::string key, const std::string& sentence)
      : std::runtime_error(sentence), kind_(kind), key_(std::move(key)) {}
  ErrorKind kind() const noexcept { return kind_; }
  const std::string& key() const noexcept { return key_; }

private:
  ErrorKind kind_;
  std::string key_;
};

/// The checkpoint that a run goes on from.
struct Restart {
  std::filesystem::path folder;
  nlohmann::json record; // its checkpoint.json
};

/// What a run needs beside its case.
struct RunSetup {
  nlohmann::json settings;          // the case with every default
  std::filesystem::path run_folder; // exists, with the subfolders history and logs
  bool plan_only = false;           // stop before the first step and write nothing
  std::string transport;            // "shm", "zmq", "loopback"
  nlohmann::json identity{};        // of case and program, kept with each checkpoint
  std::string version{};            // of kerf
  std::optional<Restart> restart{}; // nothing: from the start
  /// Called about five times a second with each participant's step.
  std::function<void(const std::string& participant, std::uint64_t step, std::uint64_t steps)>
      progress;
};

class Broker {
public:
  Broker(RunSetup setup, Supervisor& supervisor);
  ~Broker();

  /// Runs the case to its end. Whatever goes wrong, every participant is told to stop.
  /// @return what run.json keeps: the plan, and the timings when steps were made
  /// @throws RunError, Interrupted
  nlohmann::json run();

private:
  struct Member;
  struct Joint;
  using Clock = std::chrono::steady_clock;

  // The handshake, in order.
  void invite();
  void shake_hands();
  void collect_declarations();
  void make_couplings();
  void refuse_shared_points() const;
  void collect_limits();
  void choose_time_step();
  void go_on_with_schedule();
  void count_stages();
  void require_stages() const;
  void end_early(Member& member, const ConditionMet& met);
  void open_channels();

  // The steps.
  void step_loop();
  void cycle();
  void compute(Joint& joint);
  void enter_books();
  std::span<const std::byte> receive_frame(Member& member, FrameKind kind);
  std::span<std::byte> force_frame_of(Member& member);
  void send_forces(Member& member);

  // Checkpoints: the broker adds what it knows itself, and says when one is complete.
  std::filesystem::path coupling_file(const std::filesystem::path& folder,
                                      const Joint& joint) const;
  void require_checkpoints() const;
  void restore_couplings();
  bool checkpoint_is_due() const;
  void write_couplings();
  void complete_checkpoint();
  void await_last_checkpoint() noexcept;
  std::string last_checkpoint() const;

  [[noreturn]] void gave_up(const Member& member, const char* expected, const TimeoutError& error);
  Wait patience(); // the hang limit, looking after everybody meanwhile

  // The end.
  void await_finish();
  void say_goodbye();
  nlohmann::json record() const;

  // Messages beside the steps.
  /// Takes the messages that are there, waits at most `limit` for the first; looks after everybody.
  void serve(std::chrono::milliseconds limit);
  void greet(const std::string& peer, const Message& message);
  void handle(Member& member, const Message& message);
  /// Waits for one message of a type from every participant.
  void collect(const char* type, const std::function<void(Member&, const Message&)>& take);
  void tell(Member& member, const Message& message);
  void stop_all(const std::string& reason) noexcept;
  void check_silence();
  void report_progress();

  // Sentences.
  RunError last_words(const ParticipantLost& loss);
  [[noreturn]] void blame_not_finite(const Joint& joint) const;
  std::string place() const; // "at step 12 of 200", "during the handshake"
  std::string place_of(const Member& member) const;
  std::filesystem::path log_of(const Member& member) const;
  Member& member(const std::string& name);

  RunSetup setup_;
  Supervisor& supervisor_;
  std::string token_; // what a participant must show
  std::unique_ptr<ControlServer> control_;
  std::vector<Member> members_; // in the order of their names
  std::vector<Joint> joints_;   // in the order of the case
  Schedule schedule_;
  double critical_step_ = 0.0; // s
  std::string limited_by_;
  double loop_seconds_ = 0.0;
  std::uint64_t last_step_ = 0; // that case.end_time allows; the largest number without it
  nlohmann::json conditions_ = nlohmann::json::array(); // that were met, as run.json keeps them
  std::uint64_t checkpoint_ = 0;                        // step of the last complete one; 0: none
  std::uint64_t couplings_written_ = 0;                 // step of the last

  std::string phase_;         // where the run is, before its first step
  std::uint64_t step_ = 0;    // n, afterwards
  const char* expected_ = ""; // the type that collect() waits for
  std::function<void(Member&, const Message&)> take_;
  Clock::time_point last_service_{};
  Clock::time_point last_report_{};
};

} // namespace kerf::coupler
