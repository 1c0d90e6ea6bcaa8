// What the machine itself can do, measured in the same run, so that figures can be compared.
#pragma once

#include <nlohmann/json.hpp>

#include <span>

namespace kerf::benchmarks {

/// Prints the processor, its load and the set of instructions in use; measures the memory bandwidth
/// (triad of 600 MB) and the rate of double multiply-adds, the best of five each.
/// @return {"triad": {threads: {"limit": GB/s}}, "fma": {threads: {"limit": GFLOP/s}}}
nlohmann::json machine(std::span<const int> threads);

} // namespace kerf::benchmarks
