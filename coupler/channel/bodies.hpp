// What the control messages of a run say, as plain structs, and how each becomes a message.
#pragma once

#include "coupler/channel/channel.hpp"
#include "coupler/protocol/field.hpp"
#include "coupler/protocol/frame.hpp"
#include "coupler/protocol/message.hpp"
#include "coupler/protocol/protocol_error.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kerf::coupler {

/// The first message of a participant.
struct Hello {
  std::uint32_t protocol = protocol_version;
  std::string name;  // of the participant in the case
  std::string token; // the secret of this run, handed down by the launcher
  std::int64_t pid = 0;
  std::string program; // name and version, for run.json
};

/// What a participant is told when it joins.
struct Assignment {
  std::string name;                 // of the participant
  std::string settings;             // its table of the case with every default, JSON text
  std::string case_settings;        // the table [case] with every default, JSON text
  std::filesystem::path run_folder; // results go here; files of the case are given as full paths
  bool plan_only = false;           // no step will follow and no file may be written
  std::int64_t broker_pid = 0;      // to name the broker in a sentence about its end
  std::filesystem::path restart{};  // folder of the checkpoint to go on from; empty: the start
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
  int nodes_per_element = 0;           // 3, 4 in 2D: tri3, quad4; 4, 8 in 3D: tet4, hex8; VTK order
  std::vector<std::uint32_t> elements; // [num_elements][nodes_per_element] local node indices
  /// Faces by tag, [num_faces][nodes_per_face()] local node indices.
  std::map<std::string, std::vector<std::uint32_t>> boundary;

  double memory_estimate = 0.0; // bytes
  bool has_checkpoints = false; // it writes checkpoints and goes on from them
  bool has_stages = false;      // it sees to stages and stop conditions

  std::size_t num_points() const noexcept { return ids.size(); }
  /// 2 in 2D; in 3D 3 for tet4 and 4 for hex8.
  int nodes_per_face() const noexcept;
};

/// The points of one coupling on this participant, and what they exchange.
struct Interface {
  std::string coupling;
  std::vector<std::uint32_t> points; // [n] local indices of the declaration, ascending
  std::vector<double> stiffness;     // [n] of the penalty, N/m; empty for other methods
  std::vector<Field> motion = {Field::position, Field::velocity}; // published
  std::vector<Field> forces = {Field::force}; // received; own resultants have the same fields
};

/// The broker's answer to a declaration.
struct Plan {
  /// Blending of each point. Nodes: alpha, interpolated to the quadrature points. Particles:
  /// 1 - alpha, which goes on linearly outside the zone, above one. A contact takes it at its
  /// point, (r_j w_i + r_i w_j) / (r_i + r_j); then contacts and particles bound it to 0.05 … 1.
  /// [num_points]; empty: one everywhere.
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

/// When to step and when to write, and where the frames go.
struct Schedule {
  double time_step = 0.0;          // s
  std::uint64_t steps = 0;         // the run ends at steps * time_step
  std::uint64_t history_every = 1; // a row at every multiple, and at the end
  std::uint64_t frame_every = 0;   // a frame at every multiple, and at the end; 0: none at all
  /// Steps at which the stages end, ascending; the last one need not be reached. Without stages
  /// that of the run, or nothing.
  std::vector<std::uint64_t> ends = {};
  std::uint64_t first_step = 0;       // where the loop begins: that of the checkpoint
  std::uint64_t checkpoint_every = 0; // one at every multiple, and at the end; 0: none
  std::uint64_t layout = 0; // FrameLayout::checksum() that both sides must have; 0: no frames
  /// Not to be read by solvers. No transport: the participant has no interface. The descriptor
  /// does not travel: a participant uses the one it inherited, or opens the endpoint.
  ChannelAddress channel = {};
};

/// How far a participant is.
struct Progress {
  std::uint64_t step = 0;
  double waiting_seconds = 0.0; // so far, for the broker and so for the others
};

/// A participant has written its part of a checkpoint.
struct CheckpointReport {
  std::uint64_t step = 0; // the one that it goes on with
};

/// A stop condition is met in a step, which is the last one of the run or the stage.
struct ConditionMet {
  std::uint64_t step = 0;
  std::string name;
  double value = 0.0; // of the quantity
};

/// The broker's answer: the schedule from now on.
struct Ends {
  std::uint64_t steps = 0;
  std::vector<std::uint64_t> ends;
};

/// What a participant says when its loop has ended.
struct Finished {
  std::uint64_t steps = 0;
  double compute_seconds = 0.0;  // from the first step to the end, less the two below
  double exchange_seconds = 0.0; // inside publish_motion() and publish_forces()
  double waiting_seconds = 0.0;  // inside receive()
  std::string summary = "{}";    // JSON object of the solver, for run.json
};

/// Why a participant cannot go on.
struct ErrorReport {
  ErrorKind kind = ErrorKind::failed;
  std::string key; // bad_input: path inside the participant's own table
  std::string sentence;
  std::uint64_t step = 0;
};

/// Ends a participant, or refuses it.
struct Stop {
  std::string reason; // one sentence for the participant's log
};

/// @throws std::invalid_argument when text that should be a JSON object is none
Message to_message(const Hello& body);
Message to_message(const Assignment& body);
Message to_message(const Declaration& body);
Message to_message(const Plan& body);
Message to_message(const Limits& body);
Message to_message(const Schedule& body);
Message to_message(const Progress& body);
Message to_message(const CheckpointReport& body);
Message to_message(const ConditionMet& body);
Message to_message(const Ends& body);
Message to_message(const Finished& body);
Message to_message(const ErrorReport& body);
Message to_message(const Stop& body);

/// The body of a message, checked as far as it can be without its context: types, sizes that must
/// agree, finite numbers, indices in range.
///
///     const auto hello = from_message<Hello>(incoming.message);
///
/// @throws ProtocolError also when the message is of another type; the text names both
template <class Body> Body from_message(const Message& message);
template <> Hello from_message<Hello>(const Message& message);
template <> Assignment from_message<Assignment>(const Message& message);
template <> Declaration from_message<Declaration>(const Message& message);
template <> Plan from_message<Plan>(const Message& message);
template <> Limits from_message<Limits>(const Message& message);
template <> Schedule from_message<Schedule>(const Message& message);
template <> Progress from_message<Progress>(const Message& message);
template <> CheckpointReport from_message<CheckpointReport>(const Message& message);
template <> ConditionMet from_message<ConditionMet>(const Message& message);
template <> Ends from_message<Ends>(const Message& message);
template <> Finished from_message<Finished>(const Message& message);
template <> ErrorReport from_message<ErrorReport>(const Message& message);
template <> Stop from_message<Stop>(const Message& message);

/// The first thing that is wrong, as half a sentence with the numbers, or an empty string. The
/// caller knows whose fault it is: a participant throws std::invalid_argument at its solver, the
/// broker ProtocolError at a participant.
std::string fault_in(const Declaration& declaration);
std::string fault_in(const Plan& plan, std::size_t num_points);
std::string fault_in(const Limits& limits, const Plan& plan, int dimension);

} // namespace kerf::coupler
