// Random numbers that are the same on every machine.
#pragma once

#include <cstdint>
#include <random>

namespace kerf::dem {

/// The engine is the standard's, bit for bit; its distributions are not portable, so this maps the
/// bits itself.
class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// In [0, count).
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(uniform() * static_cast<double>(count));
  }

private:
  std::mt19937_64 engine_;
};

} // namespace kerf::dem
