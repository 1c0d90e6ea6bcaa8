// All that a solver needs to take part in a coupled run: connect, declare, initialize, then the
// five calls of every step, and finalize.
#pragma once

#include "coupler/protocol/message.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

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

/// What a participant is told when it joins.
struct Assignment {
  std::string name;                 // of the participant
  std::string settings;             // its table of the case with every default, JSON text
  std::string case_settings;        // the table [case] with every default, JSON text
  std::filesystem::path run_folder; // results go here; files of the case are given as full paths
  bool plan_only = false;           // no step will follow and no file may be written
};

/// What a participant brings. Points are particles or nodes; local index k is row k.
struct Declaration {
  int dimension = 2;
  std::vector<std::int64_t> ids; // [num_points] global and unique
  std::vector<double> positions; // [num_points][dimension] reference configuration, m

  // Particles only.
  std::vector<double> radii;     // [num_points] m
  std::vector<double> stiffness; // [num_points] normal contact stiffness that penalties scale, N/m

  // Meshes only.
  int nodes_per_element = 0;           // 4: quad4 in 2D; 8: hex8 in 3D; VTK's node order
  std::vector<std::uint32_t> elements; // [num_elements][nodes_per_element] local node indices
  /// Faces by tag, [num_faces][nodes_per_face] local node indices (2 in 2D, 4 for hex8).
  std::map<std::string, std::vector<std::uint32_t>> boundary;

  double memory_estimate = 0.0; // bytes
};

/// The points of one coupling on this participant.
struct Interface {
  std::string coupling;
  std::vector<std::uint32_t> points; // [n] local indices of the declaration, ascending
  std::vector<double> stiffness;     // [n] of the penalty, N/m; empty for other methods
};

/// The broker's answer to a declaration.
struct Plan {
  /// Share of each point in the blended virtual work: w_i of particles, alpha of nodes
  /// (interpolated to the quadrature points). [num_points]; empty: one everywhere.
  std::vector<double> weights;
  std::vector<Interface> interfaces;
  bool needs_own_forces = false; // a method that solves for the forces: publish_forces() matters
};

/// What limits the time step, blended with the weights of the plan.
struct Limits {
  std::vector<std::vector<double>> inverse_mass; // [interfaces][n][dimension] 1/kg; 0: prescribed
  std::vector<std::vector<double>> omega2;       // [interfaces][n] own row sum of M^-1 K, rad²/s²
  double largest_omega2 = 0.0;                   // over the whole participant, rad²/s²
  std::string limited_by; // what has it: "particle 17", "element 3 (tag rock)"
};

/// When to step and when to write.
struct Schedule {
  double time_step = 0.0;          // s
  std::uint64_t steps = 0;         // the run ends at steps * time_step
  std::uint64_t history_every = 1; // a row at every multiple, and at the end
  std::uint64_t frame_every = 0;   // a frame at every multiple, and at the end; 0: none at all
};

/// One participant's place in a run. Not thread-safe; one object a process.
///
///     auto me = Participant::join();
///     const Plan& plan = me.declare(…);
///     const Schedule& schedule = me.initialize(…);
///     while (me.has_next_step()) {
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

  bool has_next_step();
  std::uint64_t step() const; // n of the current step, from 0
  double time() const;        // n * time_step, s

  std::span<double> position(std::size_t interface); // [n][dimension] x^n, m
  /// [n][dimension] v^(n-1/2), m/s; v^0 in the first step. A prescribed component gives the
  /// velocity with which it is about to move, v^(n+1/2).
  std::span<double> velocity(std::size_t interface);
  void publish_motion();
  std::span<double> own_forces(std::size_t interface); // [n][dimension] N
  void publish_forces(); // sends nothing unless the plan needs_own_forces
  void receive();
  std::span<const double> interface_forces(std::size_t interface) const; // [n][dimension] N

  /// Ends the run: reports the time spent waiting and what the caller adds, waits for the others.
  /// @param summary  JSON object for run.json, for example timings by phase
  void finalize(const std::string& summary = "{}");

  /// Tells the broker why this participant cannot go on; the caller then ends the process.
  void fail(ErrorKind kind, const std::string& key, const std::string& sentence) noexcept;

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace kerf::coupler
