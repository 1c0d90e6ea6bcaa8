// Speed and memory of the particle engine.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace kerf::benchmarks {

struct DemOptions {
  std::vector<std::string> workloads; // by name; empty: all
  std::vector<int> threads = {1, 2};
  int rounds = 5;
  int steps = 0;      // in a timed block; 0: 20 million particle-steps
  bool peers = false; // YADE, LAMMPS and LIGGGHTS, too
};

/// Times every workload, codes and numbers of threads in turn, and prints a table.
/// @return {workload: {threads: {code: value}}}: 1e6 particle-steps/s by the name of the workload,
///         steps that one renewal of the contact list takes by "renewal_…", byte a particle by
///         "memory_…"
/// @throws std::invalid_argument for an unknown workload
/// @throws std::runtime_error when the list was renewed in a timed block, or a peer is missing or
///         fails
nlohmann::json dem(const DemOptions& options);

/// Times a shaken lattice from 5000 to 2 000 000 particles on one thread.
/// @return {"sweep_<particles>": {"1": {"kerf": 1e6 particle-steps/s}}}
nlohmann::json dem_sweep(int rounds);

} // namespace kerf::benchmarks
