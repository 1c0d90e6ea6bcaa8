// The programs that the suite of participants is run against, each with a small free body.
#pragma once

#include "common/config/case_file.hpp"

#include <cstddef>
#include <fmt/format.h>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace kerf::coupler {

struct Solver {
  std::string name;                 // with which the program calls itself
  std::vector<std::string> command; // the program first
  int dimension = 2;
  std::string table;              // of the participant in the case, TOML; empty: it reads none
  std::vector<std::string> damps; // overrides that damp the body, as far as the solver can
  std::size_t points = 0;
  int nodes_per_element = 0; // 0: particles
  bool blends = true;        // weights of the plan make it lighter
  bool is_elastic = true;    // it has forces of its own
};

inline const Solver echo{
    .name = "kerf-echo",
    .command = {KERF_PROGRAMS "/kerf-echo", "--points", "7", "--dimension", "2"},
    .table = "",
    .damps = {},
    .points = 7,
    .blends = false,
    .is_elastic = false};

inline const Solver dem{.name = "kerf-dem",
                        .command = {KERF_PROGRAMS "/kerf-dem"},
                        .table = R"(
kind = "dem"
particles.lattice = { type = "triangular", spacing = 1e-3, origin = [0.0, 0.0], count = [3, 3] }
material = { density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 2e9 }
initial = [{ kind = "velocity", velocity = [0.5, -0.25] }]
)",
                        .damps = {"participants.body.damping.translation=0.2"},
                        .points = 9};

inline const Solver fem{.name = "kerf-fem",
                        .command = {KERF_PROGRAMS "/kerf-fem"},
                        .table = R"(
kind = "fem"
mesh = { origin = [0.0, 0.0], size = [3e-3, 2e-3], count = [3, 2] }
material = { density = 2358.0, young_modulus = 1.2e10, poisson_ratio = 0.2 }
initial = [{ kind = "velocity", velocity = [0.5, -0.25] }]
)",
                        .damps = {},
                        .points = 12,
                        .nodes_per_element = 4};

inline void PrintTo(const Solver& solver, std::ostream* out) {
  *out << solver.name;
}

/// What an assignment says to a solver: its own table and the table [case], JSON with all defaults.
inline std::pair<std::string, std::string> settings_of(const Solver& solver,
                                                       const std::vector<std::string>& overrides) {
  const std::string text = fmt::format("[case]\nname = \"conformance\"\ndimension = {}\n"
                                       "end_time = 1.0\n[participants.body]\n",
                                       solver.dimension);
  if (solver.table.empty())
    return {"{}", fmt::format(R"({{"dimension": {}}})", solver.dimension)};
  const auto settings =
      CaseFile::parse(text + solver.table, "case.toml", ".", overrides).settings();
  return {settings.at("participants").at("body").dump(), settings.at("case").dump()};
}

} // namespace kerf::coupler
