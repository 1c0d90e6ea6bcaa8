#include "fem_core/mesh/axis.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace kerf::fem {

std::vector<double> positions_along(const Axis& axis, std::string_view name, const AxisKeys& keys) {
  if (!(axis.length > 0.0 && std::isfinite(axis.length) && std::isfinite(axis.origin)))
    throw InputError(
        std::string(keys.length),
        fmt::format("the size along {} is {} m; it must be positive", name, axis.length));
  if (axis.count == 0)
    throw InputError(std::string(keys.count),
                     fmt::format("there must be at least one element along {}", name));
  if (!(axis.grading > 0.0 && std::isfinite(axis.grading)))
    throw InputError(std::string(keys.grading),
                     fmt::format("the grading along {} is {}; it must be positive: the size of the "
                                 "last element over that of the first",
                                 name, axis.grading));
  if (axis.count == 1 && axis.grading != 1.0)
    throw InputError(std::string(keys.grading),
                     fmt::format("the grading along {} is {}, but there is a single element; give "
                                 "1, or more elements",
                                 name, axis.grading));
  const double count = axis.count;
  // Element k has the size q^k of the first one, so node k lies at (q^k - 1) / (q^count - 1).
  const double log_q = axis.count > 1 ? std::log(axis.grading) / (count - 1.0) : 0.0;
  std::vector<double> positions(axis.count + std::size_t{1});
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double at = static_cast<double>(k);
    positions[k] =
        axis.origin + (axis.grading == 1.0
                           ? axis.length * at / count
                           : axis.length * (std::expm1(at * log_q) / std::expm1(count * log_q)));
  }
  return positions;
}

void check_numbering(double num_corners) {
  if (num_corners > std::numeric_limits<std::uint32_t>::max())
    throw InputError("mesh.count", "the mesh has more corners than 32 bits can number");
}

} // namespace kerf::fem
