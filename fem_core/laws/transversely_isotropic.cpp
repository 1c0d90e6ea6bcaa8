#include "fem_core/laws/transversely_isotropic.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/laws/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::fem {
namespace {

void check(const TransverselyIsotropic::Parameters& p, int dimension) {
  check_positive("material.density", p.density, "kg/m³");
  check_positive("material.young_in_plane", p.young_in_plane, "Pa");
  check_positive("material.young_normal", p.young_normal, "Pa");
  check_positive("material.shear_normal", p.shear_normal, "Pa");
  if (!(std::abs(p.poisson_in_plane) < 1.0))
    throw InputError(
        "material.poisson_in_plane",
        fmt::format("{} must lie between -1 and 1, both excluded", p.poisson_in_plane));
  const double most =
      std::sqrt((1.0 - p.poisson_in_plane) * p.young_in_plane / (2.0 * p.young_normal));
  if (!(std::abs(p.poisson_normal) < most))
    throw InputError("material.poisson_normal",
                     fmt::format("{} must lie between {} and {}, both excluded: beyond, some "
                                 "strain would release energy",
                                 p.poisson_normal, -most, most));
  const auto& [x, y, z] = p.axis;
  const double length = std::hypot(x, y, z);
  if (!(length > 0.0 && std::isfinite(length)))
    throw InputError("material.axis",
                     fmt::format("({}, {}, {}) must be a vector with a direction", x, y, z));
  if (dimension == 2 && z != 0.0 && (x != 0.0 || y != 0.0))
    throw InputError("material.axis", fmt::format("({}, {}, {}) must lie in the plane, or be "
                                                  "(0, 0, 1), in 2D",
                                                  x, y, z));
}

} // namespace

TransverselyIsotropic TransverselyIsotropic::from(const Parameters& p, int dimension) {
  check(p, dimension);
  const double S_pn = p.poisson_normal / p.young_in_plane; // minus the compliance, 1/Pa
  const double det = (1.0 - p.poisson_in_plane) / (p.young_in_plane * p.young_normal) -
                     2.0 * S_pn * S_pn; // of stress in plane and along the axis, from strain
  const double mu_p = p.young_in_plane / (2.0 * (1.0 + p.poisson_in_plane));
  const double C12 = 0.5 / (p.young_normal * det) - mu_p;
  const double C13 = S_pn / det;
  const double C33 = (1.0 - p.poisson_in_plane) / (p.young_in_plane * det);
  const double length = std::hypot(p.axis[0], p.axis[1], p.axis[2]);
  return {.density = p.density,
          .n = {p.axis[0] / length, p.axis[1] / length, p.axis[2] / length},
          .lambda = C12,
          .mu_p = mu_p,
          .alpha = C13 - C12,
          .beta = C33 - 2.0 * C13 + C12 + 2.0 * mu_p - 4.0 * p.shear_normal,
          .mu_n = p.shear_normal};
}

// An isotropic C' - C is positive semidefinite when mu' is at least mu_p and mu_n (shear), and so
// is its part of equal strain in the plane and strain along the axis,
//   [2 lambda' + a, sqrt2 (lambda' - C13)],  a = 2 mu' - 2 (lambda + mu_p)
//   [    ...      ,        lambda' + b   ],  b = 2 mu' - C33.
// The determinant is linear in lambda'. With mu' at its least, lambda' may be infinite: the shear
// moduli from there on are tried, in steps.
Moduli TransverselyIsotropic::bound() const {
  const double in_plane = 2.0 * (lambda + mu_p), C13 = lambda + alpha;
  const double C33 = lambda + 2.0 * alpha + 4.0 * mu_n - 2.0 * mu_p + beta;
  const double least_mu = std::max({mu_p, mu_n, (in_plane + 2.0 * C33 - 4.0 * C13) / 6.0});
  Moduli best{.lambda = std::numeric_limits<double>::infinity(), .mu = least_mu};
  for (int k = 0; k < 100; ++k) {
    const double mu = least_mu * (1.0 + 1e-7 * std::pow(1.2, k)), a = 2.0 * mu - in_plane,
                 b = 2.0 * mu - C33;
    const double root = (2.0 * C13 * C13 - a * b) / (a + 2.0 * b + 4.0 * C13);
    const Moduli tried{.lambda = std::max({root, -0.5 * a, -b}), .mu = mu};
    if (tried.uniaxial() < best.uniaxial())
      best = tried;
  }
  return best;
}

} // namespace kerf::fem
