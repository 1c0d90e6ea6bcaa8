#include "fem_core/laws/checks.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::fem {

void check_positive(const char* key, double value, const char* unit) {
  if (!(value > 0.0 && std::isfinite(value)))
    throw InputError(key, fmt::format("{} {} must be positive", value, unit));
}

void check_not_negative(const char* key, double value, const char* unit) {
  if (!(value >= 0.0 && std::isfinite(value)))
    throw InputError(key, fmt::format("{} {} must not be negative", value, unit));
}

} // namespace kerf::fem
