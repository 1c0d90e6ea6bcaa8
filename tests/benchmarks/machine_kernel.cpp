// Multiply-adds without memory. Compiled once for every set of instructions.
#include "common/lanes.hpp"

namespace kerf::KERF_ISA {

constexpr int chains = 12; // hides the latency of two units of four cycles, fits in 16 registers

int operations_per_turn() {
  return 2 * chains * width;
}

/// @return a number that depends on all of them, so that none is left out
double multiply_and_add(std::int64_t turns) {
  const Lanes factor = broadcast(0.999999), summand = broadcast(1e-6);
  Lanes value[chains];
  for (int c = 0; c < chains; ++c)
    value[c] = broadcast(c);
  for (std::int64_t turn = 0; turn < turns; ++turn)
#pragma GCC unroll 12
    for (int c = 0; c < chains; ++c)
      value[c] = value[c] * factor + summand;
  double sum = 0.0;
  for (int c = 0; c < chains; ++c)
    sum += total(value[c]);
  return sum;
}

} // namespace kerf::KERF_ISA
