// The two moduli of an isotropic linear elastic solid.
#pragma once

#include "fem_core/laws/symmetric.hpp"

namespace kerf::fem {

struct Moduli {
  double lambda = 0.0; // Lamé's first parameter, Pa
  double mu = 0.0;     // shear modulus, Pa

  [[gnu::always_inline]] double bulk() const { return lambda + 2.0 / 3.0 * mu; } // K, Pa
  [[gnu::always_inline]] double young() const {                                  // E, Pa
    return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
  }
  [[gnu::always_inline]] double uniaxial() const { return lambda + 2.0 * mu; } // C11, Pa

  /// sigma = lambda tr(eps) 1 + 2 mu eps, Pa
  template <class Number, int dim>
  [[gnu::always_inline]] Symmetric<Number, dim> stress(const Symmetric<Number, dim>& strain) const {
    return plus_isotropic<Number, dim>(2.0 * mu * strain, lambda * trace(strain));
  }
  /// 1/2 eps : C : eps, J/m³
  template <class Number, int dim>
  [[gnu::always_inline]] Number energy_density(const Symmetric<Number, dim>& strain) const {
    const Number volumetric = trace(strain);
    return 0.5 * lambda * volumetric * volumetric + mu * contract(strain, strain);
  }
};

} // namespace kerf::fem
