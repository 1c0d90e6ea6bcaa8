// What the machine itself can do, measured in the same run, so that figures can be compared.
#pragma once

#include <nlohmann/json.hpp>

#include <span>

namespace kerf::benchmarks {

/// Of a triad, a = b + s c, over arrays of together so many bytes, the best of five, 1e9 byte/s.
double bandwidth(double bytes);

/// Of double precision, in registers, all threads at once, the best of five, 1e9 operations/s.
double multiply_adds();

/// Prints the processor, its load and the set of instructions in use; measures the memory bandwidth
/// (600 MB) and the rate of multiply-adds.
/// @return {"triad": {threads: {"limit": GB/s}}, "fma": {threads: {"limit": GFLOP/s}}}
nlohmann::json machine(std::span<const int> threads);

} // namespace kerf::benchmarks
