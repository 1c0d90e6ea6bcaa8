#include "fem_core/laws/neo_hookean.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>

#include <cmath>

namespace kerf::fem {

NeoHookean NeoHookean::from(const IsotropicElastic& elastic) {
  const auto [lambda, mu] = elastic.moduli;
  if (!(lambda >= 0.0))
    throw InputError("material.poisson_ratio",
                     fmt::format("{} must not be negative for a neo-Hookean material",
                                 lambda / (2.0 * (lambda + mu))));
  return {.density = elastic.density, .moduli = elastic.moduli};
}

Moduli NeoHookean::bound(double least_J) const {
  return {.lambda = moduli.lambda, .mu = moduli.mu - moduli.lambda * std::log(least_J)};
}

} // namespace kerf::fem
