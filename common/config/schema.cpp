#include "common/config/schema.hpp"

#include "common/config/schema_rows.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::config {
namespace {

std::vector<Key> case_keys() {
  using enum Type;
  return {
      {"case", "", table, "", tables, anything, "[case]", "what the whole run shares"},
      {"case.name", "", name, "", required, anything, R"("reference")",
       "a name for files and reports"},
      {"case.dimension", "", integer, "", required, one_of({"2", "3"}), "2",
       "the dimension of space; 2 is per metre of thickness"},
      {"case.seed", "", integer, "", "1", in(from_zero), "1", "the seed of everything random"},
      {"case.end_time", "", number, "s", none, in(above_zero), "4e-5",
       "the time at which the run ends; with stages it may be left out", live},
      {"case.time_step", "", number_or_auto, "s", R"("auto")", in(above_zero), "1e-8",
       R"(the step of all participants, or "auto" for time_step_factor times the critical step)"},
      {"case.time_step_factor", "", number, "", "0.8",
       in({.least = 0.0, .most = 1.0, .without_least = true}), "0.8",
       "the share of the critical step that an automatic step takes"},
      {"case.allow_unstable", "", flag, "", "false", anything, "false",
       "whether a time step above the critical one may run"},
      {"case.transport", "", text, "", R"("shm")", one_of({"shm", "zmq"}), R"("shm")",
       "how participants and broker exchange data: shared memory or ZeroMQ"},
      {"case.hang_limit", "", number, "s", "30.0", in(above_zero), "30.0",
       "how long a participant may be silent during the run"},
      {"case.handshake_limit", "", number, "s", "60.0", in(above_zero), "60.0",
       "how long a participant may take to join and to build its model"},
      {"case.periodic", "", table, "", tables, anything, "periodic box",
       "the axes along which space repeats"},
      {"case.periodic.x", "", interval, "m", none, anything, "[0.0, 0.1]",
       "the ends of the period along x"},
      {"case.periodic.y", "", interval, "m", none, anything, "[0.0, 0.006928203230275509]",
       "the ends of the period along y"},
      {"case.periodic.z", "", interval, "m", none, anything, "[0.0, 0.1]",
       "the ends of the period along z; 3D only"},
      {"case.output", "", table, "", tables, anything, "output", "how much is written"},
      {"case.output.frames", "", integer, "", "20", in(from_zero), "20",
       "the number of frames over the run; 0 for none"},
      {"case.output.history", "", integer, "", "200", in(from_one), "200",
       "the number of rows of the time series over the run"},
      {"case.output.checkpoints", "", integer, "", "0", in(from_zero), "10",
       "the number of checkpoints over the run, from which kerf run --restart goes on; 0 for none"},
      {"case.output.keep_checkpoints", "", integer, "", "2", in(from_one), "2",
       "how many of them are kept, the newest"},
  };
}

std::vector<Key> participants_key() {
  return {{"participants", "", Type::named_tables, "", required, anything, "participant",
           "every process that takes part, by name"}};
}

std::vector<Key> coupling_and_measure_keys() {
  using enum Type;
  const Allowed kinds =
      one_of({"reflected_energy", "transmitted_energy", "energy_drift", "energy_balance_error",
              "momentum_residual", "constraint_violation", "coordination_number", "wall_time"});
  return {
      {"couplings", "", list, "", empty, anything, "coupling", "a connection of two participants"},
      {"couplings[].name", "", name, "", required, anything, R"("joint")", "a name, used once"},
      {"couplings[].type", "", text, "", R"("overlap")", one_of({"overlap"}), R"("overlap")",
       "the kind of connection: overlap blends particles and elements in a zone that both fill"},
      {"couplings[].between", "", pair, "", required, anything, R"(["rock", "far"])",
       "the names of the two participants, one dem and one fem"},
      {"couplings[].boundary", "", text, "", required, anything, R"("left")",
       "the tag of the mesh boundary where the zone begins, on the side of the particles"},
      {"couplings[].width", "", number, "m", required, in(above_zero), "1e-2",
       "the width of the zone, into the mesh"},
      {"couplings[].method", "", text, "", R"("lagrange")", one_of({"lagrange", "penalty"}),
       R"("lagrange")", "how the two motions are tied: exactly, or by springs"},
      {"couplings[].stiffness_ratio", "", number, "", "1.0", in(above_zero), "1.0",
       "the stiffness of the penalty springs over the normal contact stiffness"},
      {"couplings[].stiffness_profile", "", text, "", R"("blended")",
       one_of({"blended", "uniform"}), R"("blended")",
       "the penalty stiffness over the zone: times 4 alpha (1 - alpha), or uniform"},
      {"couplings[].blending", "", flag, "", "true", anything, "true",
       "whether energy is shared between particles and elements in the zone"},
      {"measures", "", list, "", empty, anything, "measure", "a number in the summary of the run"},
      {"measures[].name", "", name, "", required, anything, R"("energy_balance_error")",
       "a name, used once"},
      {"measures[].kind", "", text, "", none, kinds, R"("energy_balance_error")",
       "what is measured; the name when not given"},
      {"measures[].participant", "", text, "", none, anything, R"("rock")",
       "the participant it is of"},
      {"measures[].reference", "", text, "", none, anything, R"("rock")",
       "the participant that it is compared with"},
      {"measures[].coupling", "", text, "", none, anything, R"("joint")", "the coupling it is of"},
      {"measures[].box", "", box, "m", none, anything, "[[-1.0, -1.0], [1.0, 1.0]]",
       "the lower and upper corner of the region that is measured"},
      {"measures[].expect", "", optional_table, "", none, anything, "expectation",
       "what the value must be for the run to pass", live},
      {"measures[].expect.min", "", number, "", none, anything, "0.0",
       "the least value that passes"},
      {"measures[].expect.max", "", number, "", none, anything, "1e-3",
       "the largest value that passes", live},
  };
}

} // namespace

const std::vector<Key>& schema() {
  static const std::vector<Key> all = [] {
    std::vector<Key> keys = case_keys();
    for (const auto& part :
         {stop_keys("case.stop"), participants_key(), particle_keys(), mesh_keys(),
          coupling_and_measure_keys(), stage_keys(particle_keys(), mesh_keys())})
      keys.insert(keys.end(), part.begin(), part.end());
    return keys;
  }();
  return all;
}

bool Range::has(double value) const {
  return (without_least ? value > least : value >= least) &&
         (without_most ? value < most : value <= most) && std::isfinite(value);
}

std::string Range::text() const {
  const bool below = std::isfinite(least), above = std::isfinite(most);
  if (below && above && !without_least && !without_most)
    return fmt::format("from {} to {}", least, most);
  std::string text;
  if (below)
    text = fmt::format("{} {}", without_least ? "greater than" : "at least", least);
  if (above)
    text +=
        fmt::format("{}{} {}", below ? " and " : "", without_most ? "less than" : "at most", most);
  return text;
}

std::string Allowed::text() const {
  if (choices.empty())
    return range.text();
  std::string text = choices.front();
  for (std::size_t k = 1; k < choices.size(); ++k)
    text += (k + 1 < choices.size() ? ", " : " or ") + choices[k];
  return text;
}

std::string Key::last() const {
  return path.substr(path.rfind('.') + 1);
}

std::vector<const Key*> keys_of(std::string_view table, std::string_view kind) {
  const std::string prefix = table.empty() ? "" : std::string(table) + ".";
  std::vector<const Key*> keys;
  for (const Key& key : schema())
    if (key.path.starts_with(prefix) && key.path.find('.', prefix.size()) == std::string::npos &&
        (key.kind.empty() || key.kind == kind))
      keys.push_back(&key);
  return keys;
}

std::string inside(const Key& key) {
  if (key.type == Type::list)
    return key.path + "[]";
  return key.type == Type::named_tables ? key.path + ".*" : key.path;
}

} // namespace kerf::config
