// All that a solver needs to take part in a coupled run: connect, declare, initialize, then the
// five calls of every step, and finalize.
#pragma once

#include "coupler/channel/bodies.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

namespace kerf::coupler {

/// The run was ended from outside: by the broker, or because the broker is gone. The text is one
/// sentence for the participant's own log.
class RunStopped : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The case cannot be used; the key says where in the case file the fault is.
class SettingsError : public std::runtime_error {
public:
  /// @param key  path inside the participant's own table, for example "boundary[0].tag"
  SettingsError(std::string key, const std::string& sentence)
      : std::runtime_error(sentence), key_(std::move(key)) {}
  const std::string& key() const noexcept { return key_; }

private:
  std::string key_;
};

/// One participant's place in a run. Not thread-safe; one object a process.
///
///     auto me = Participant::join();
///     const Plan& plan = me.declare(…);
///     const Schedule& schedule = me.initialize(…);
///     while (me.has_next_step()) {
///       if (me.checkpoint_is_due()) { …; me.report_checkpoint(); } // who has_checkpoints
///       … write me.position(i), me.velocity(i);    me.publish_motion();
///       … own forces, write me.own_forces(i);      me.publish_forces();
///       me.receive();                              … read me.interface_forces(i), integrate
///     }
///     me.finalize();
class Participant {
public:
  struct Invitation {     // filled from the environment by join()
    std::string endpoint; // KERF_BROKER: ZeroMQ address of the broker's control socket
    std::string name;     // KERF_PARTICIPANT
    std::string token;    // KERF_TOKEN
    int segment = -1;     // KERF_SEGMENT: inherited descriptor of the shared memory
    int lifeline = -1;    // KERF_LIFELINE: inherited read end of a pipe that ends with the broker
    std::string program = "unknown"; // name and version, for run.json
    /// Without a lifeline: how long a broker may take to answer the first message.
    std::chrono::milliseconds join_limit = std::chrono::seconds(60);
  };

  /// Joins the run that started this process.
  /// @throws std::invalid_argument when the environment names no broker
  /// @throws RunStopped when the broker refuses, with its reason
  static Participant join(const std::string& program);
  explicit Participant(const Invitation& invitation);
  ~Participant();
  Participant(Participant&&) noexcept;
  Participant& operator=(Participant&&) noexcept;

  const Assignment& assignment() const;
  /// @throws std::invalid_argument when the arrays do not fit one another
  const Plan& declare(const Declaration& declaration);
  /// @throws std::invalid_argument when the arrays do not fit the plan
  const Schedule& initialize(const Limits& limits);

  /// Begins the next step, if there is one.
  /// @throws RunStopped when the run was ended; std::logic_error when a call of the last step is
  ///         missing
  bool has_next_step();
  std::uint64_t step() const; // n of the current step, from 0
  double time() const;        // n * time_step, s

  /// True when the state of the beginning of this step is to be written before the step is made:
  /// every few steps, at the end of the loop, and before the broker stops the run.
  bool checkpoint_is_due() const;
  /// Where to write it: "<run folder>/checkpoints/<step>/<name>.h5".
  std::filesystem::path checkpoint_file() const;
  /// Where to go on from; empty when the run begins at its start.
  std::filesystem::path restart_file() const;
  /// Says that the checkpoint of this step is complete.
  /// @throws RunStopped when it was the last thing that the broker wanted
  void report_checkpoint();

  /// Stage of the current step, from 0; its first step, at which its changes are made.
  std::size_t stage() const;
  std::uint64_t stage_begin() const;
  /// Stage of the step before this one; 0 before the first.
  std::size_t stage_before(std::uint64_t step) const;
  /// Says, after integrating a step, that it meets a stop condition. The broker then ends the run
  /// or the stage, and steps() and the stages change.
  void report_condition(const std::string& name, double value);

  // The spans point into the frame of this step: write them before it is published, and ask for
  // them anew in the next step.
  std::span<double> position(std::size_t interface); // [n][dimension] x^n, m
  /// [n][dimension] v^(n-1/2), m/s; v^0 in the first step. A prescribed component gives the
  /// velocity with which it is about to move, v^(n+1/2).
  std::span<double> velocity(std::size_t interface);
  void publish_motion();
  std::span<double> own_forces(std::size_t interface); // [n][dimension] N
  void publish_forces(); // sends nothing unless the plan needs_own_forces
  /// Waits for the interface forces of this step.
  /// @throws RunStopped, ProtocolError
  void receive();
  std::span<const double> interface_forces(std::size_t interface) const; // [n][dimension] N

  /// Ends the run: reports the time spent waiting and what the caller adds, waits for the others.
  /// @param summary  JSON object for run.json, for example timings by phase
  /// @throws std::invalid_argument when the summary is no JSON object
  void finalize(const std::string& summary = "{}");

  /// Tells the broker why this participant cannot go on; the caller then ends the process.
  void fail(ErrorKind kind, const std::string& key, const std::string& sentence) noexcept;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace kerf::coupler
