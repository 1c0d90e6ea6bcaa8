#include "fem_core/laws/drucker_prager.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/laws/checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace kerf::fem {
namespace {

struct Cone {
  double eta, xi;
};

/// de Souza Neto et al. (2008), section 6.4.4
Cone cone(DruckerPrager::Fit fit, double angle) {
  const double sine = std::sin(angle), cosine = std::cos(angle);
  if (fit == DruckerPrager::Fit::plane_strain) {
    const double tangent = sine / cosine, root = std::sqrt(9.0 + 12.0 * tangent * tangent);
    return {3.0 * tangent / root, 3.0 / root};
  }
  const double side = fit == DruckerPrager::Fit::outer ? -sine : sine;
  const double below = std::numbers::sqrt3 * (3.0 + side);
  return {6.0 * sine / below, 6.0 * cosine / below};
}

} // namespace

DruckerPrager DruckerPrager::from(const IsotropicElastic& elastic, const Parameters& p) {
  check_not_negative("material.cohesion", p.cohesion, "Pa");
  if (!(p.friction_angle >= 0.0 && p.friction_angle < std::numbers::pi / 2.0))
    throw InputError("material.friction_angle",
                     fmt::format("{} rad must lie from 0 to below pi/2", p.friction_angle));
  if (!(p.dilation_angle >= 0.0 && p.dilation_angle <= p.friction_angle))
    throw InputError("material.dilation_angle",
                     fmt::format("{} rad must lie from 0 to friction_angle = {} rad",
                                 p.dilation_angle, p.friction_angle));
  if (p.cohesion == 0.0 && p.friction_angle == 0.0)
    throw InputError("material.cohesion", "0 Pa must be positive where friction_angle is 0");
  const auto [eta, xi] = cone(p.fit, p.friction_angle);
  const double strength = xi * p.cohesion;
  const double apex = eta > 0.0 ? strength / eta : std::numeric_limits<double>::max();
  if (!(p.tension_cutoff <= apex))
    throw InputError(
        "material.tension_cutoff",
        fmt::format("{} Pa must not be above the apex of the cone, {} Pa", p.tension_cutoff, apex));
  const double cutoff = p.tension_cutoff < 0.0 ? apex : p.tension_cutoff;
  return {.density = elastic.density,
          .moduli = elastic.moduli,
          .eta = eta,
          .flow_eta = cone(p.fit, p.dilation_angle).eta,
          .strength = strength,
          .cutoff = cutoff,
          .corner = cutoff == apex && eta > 0.0 ? 0.0 : strength - eta * cutoff};
}

} // namespace kerf::fem
