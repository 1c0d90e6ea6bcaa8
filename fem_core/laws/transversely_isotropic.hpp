// The transversely isotropic linear elastic solid: layered or schistose rock.
#pragma once

#include "fem_core/laws/moduli.hpp"

#include <array>

namespace kerf::fem {

/// Isotropic in the plane normal to the axis n, with the invariants of Spencer:
/// sigma = (lambda tr(eps) + alpha e_n) 1 + 2 mu_p eps + (alpha tr(eps) + beta e_n) n n
///         + 2 (mu_n - mu_p) (n v + v n), v = eps n, e_n = n v.
/// As with every anisotropic law the strain must be small or turned back with the material (Green
/// strain gives the second Piola-Kirchhoff stress): update() does not turn the axis.
/// @see Spencer, Constitutive theory for strongly anisotropic solids (1984),
///      doi:10.1007/978-3-7091-4336-0_1
struct TransverselyIsotropic {
  struct Parameters {
    double density = 0.0;          // of the bulk, kg/m³
    double young_in_plane = 0.0;   // E_p, Pa
    double young_normal = 0.0;     // E_n, along the axis, Pa
    double poisson_in_plane = 0.0; // nu_p
    /// nu_pn: contraction along the axis over extension in the plane, for stress in the plane;
    /// stress along the axis contracts the plane by nu_np = nu_pn E_n / E_p
    double poisson_normal = 0.0;
    double shear_normal = 0.0; // G_n, of planes through the axis, Pa
    /// n, of any length. In 2D in the plane, or (0, 0, 1).
    std::array<double, 3> axis = {0.0, 0.0, 1.0};
  };

  static constexpr int history = 0;
  static constexpr std::array<const char*, history> history_names{}, history_units{};

  double density = 0.0;            // kg/m³
  double n[3] = {0.0, 0.0, 1.0};   // unit vector
  double lambda = 0.0, mu_p = 0.0; // Pa
  double alpha = 0.0, beta = 0.0;  // Pa
  double mu_n = 0.0;               // Pa

  /// @throws InputError unless every strain stores energy, E_p, E_n, G_n > 0, -1 < nu_p < 1 and
  ///         nu_pn² < (1 - nu_p) E_p / (2 E_n), and the axis fits the dimension
  static TransverselyIsotropic from(const Parameters& parameters, int dimension);

  /// The isotropic solid of about the least wave speed whose energy is above that of this one for
  /// every strain.
  Moduli bound() const;

  std::array<double, history> initial_history(double /*length*/) const { return {}; }

  /// @param strain  small strain
  /// @returns Pa
  template <class Math, int dim>
  [[gnu::always_inline]] Symmetric<typename Math::Number, dim>
  stress(const Symmetric<typename Math::Number, dim>& strain) const {
    using Number = typename Math::Number;
    Number v[3];
    if constexpr (dim == 2) {
      v[0] = n[0] * strain[0] + n[1] * strain[3];
      v[1] = n[0] * strain[3] + n[1] * strain[1];
      v[2] = n[2] * strain[2];
    } else {
      v[0] = n[0] * strain[0] + n[1] * strain[5] + n[2] * strain[4];
      v[1] = n[0] * strain[5] + n[1] * strain[1] + n[2] * strain[3];
      v[2] = n[0] * strain[4] + n[1] * strain[3] + n[2] * strain[2];
    }
    const Number e_n = n[0] * v[0] + n[1] * v[1] + n[2] * v[2], volumetric = trace(strain);
    const Number along = alpha * volumetric + beta * e_n;
    auto sigma =
        plus_isotropic<Number, dim>(2.0 * mu_p * strain, lambda * volumetric + alpha * e_n);
    for (int i = 0; i < 3; ++i) { // n v + v n, with half of n n in v
      v[i] = 2.0 * (mu_n - mu_p) * v[i] + (0.5 * n[i]) * along;
      sigma[i] = sigma[i] + 2.0 * n[i] * v[i];
    }
    if constexpr (dim == 2) {
      sigma[3] = sigma[3] + (n[0] * v[1] + n[1] * v[0]);
    } else {
      sigma[3] = sigma[3] + (n[1] * v[2] + n[2] * v[1]);
      sigma[4] = sigma[4] + (n[0] * v[2] + n[2] * v[0]);
      sigma[5] = sigma[5] + (n[0] * v[1] + n[1] * v[0]);
    }
    return sigma;
  }
  /// 1/2 eps : C : eps, J/m³
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  energy_density(const Symmetric<typename Math::Number, dim>& strain) const {
    return 0.5 * contract(strain, stress<Math, dim>(strain));
  }
  /// Adds C : increment to the stress; nothing is dissipated.
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* /*kept*/,
         const Symmetric<typename Math::Number, dim>& strain_increment,
         double /*time_step*/) const {
    stress = stress + this->stress<Math, dim>(strain_increment);
    return typename Math::Number{};
  }
};

} // namespace kerf::fem
