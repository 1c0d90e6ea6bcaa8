// Speed and memory of the finite element engine.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace kerf::benchmarks {

struct FemOptions {
  std::vector<std::string> workloads; // of fem_workloads(); empty: all
  std::vector<std::string> laws;      // of fem_laws; empty: all
  std::vector<int> threads = {1, 2};
  int rounds = 5;
  int steps = 0;      // in a timed block; 0: 20 million element-steps
  bool large = false; // eight times as many elements
  bool peers = false; // FEniCSx and deal.II, too
};

/// Times every workload with every law, codes and numbers of threads in turn, and prints a table.
/// @return {workload: {threads: {code: value}}}: 1e6 element-steps/s by the name of the workload,
///         with _<law> for all but total_strain and _large for large ones; byte an element by
///         "memory_…"
/// @throws std::runtime_error when a peer is missing, fails or computes something else
nlohmann::json fem(const FemOptions& options);

/// Times workloads, hex8 unless there are others, with the first of the laws, from 10 000 to
/// 3 000 000 elements on one thread.
/// @return {"sweep_<workload>_<elements>": {"1": {"kerf": 1e6 element-steps/s}}}
nlohmann::json fem_sweep(const FemOptions& options);

} // namespace kerf::benchmarks
