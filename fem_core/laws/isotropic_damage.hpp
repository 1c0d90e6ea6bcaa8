// Isotropic damage of quasi-brittle rock and concrete.
#pragma once

#include "fem_core/laws/isotropic_elastic.hpp"

namespace kerf::fem {

/// sigma = (1 - D) C : eps, with D of the largest equivalent strain k so far. That is the modified
/// von Mises strain, in terms of the stress S = C : eps of the sound material,
///   E k = ((r - 1) I1 + sqrt((r - 1)² I1² + 12 r J2)) / (2 r),  r = f_c / f_t,
/// which is the strain of uniaxial tension, and 1/r of that of uniaxial compression. Softening is
/// exponential, D = 1 - (k_0 / k) exp(-(k - k_0) / k_s), k_0 = f_t / E. Its slope k_s makes the
/// work of complete failure in tension G_f / h for an element of length h (crack band), whatever
/// the mesh. Cracks that close do not regain stiffness.
/// @see de Vree, Brekelmans & van Gils, Comput. Struct. 55 (1995) 581-588,
///      doi:10.1016/0045-7949(94)00501-S; Bažant & Oh, Mater. Struct. 16 (1983) 155-177,
///      doi:10.1007/BF02486267
struct IsotropicDamage {
  struct Parameters {
    double tensile_strength = 0.0; // f_t, Pa
    double strength_ratio = 10.0;  // r, compressive over tensile
    double fracture_energy = 0.0;  // G_f, J/m²
  };

  static constexpr int history = 3;
  static constexpr std::array<const char*, history> history_names{"damage", "equivalent_strain",
                                                                  "characteristic_length"};
  static constexpr std::array<const char*, history> history_units{"1", "1", "m"};

  /// A rest of stiffness stays: the stress of the sound material is found from the stress.
  static constexpr double most_damage = 1.0 - 1e-9;

  double density = 0.0; // kg/m³
  Moduli moduli;        // of the sound material
  double tensile_strength = 0.0, strength_ratio = 0.0, fracture_energy = 0.0;

  /// @throws InputError unless f_t > 0, r >= 1 and G_f > 0
  static IsotropicDamage from(const IsotropicElastic& elastic, const Parameters& parameters);

  /// The moduli of the sound material: damage only makes it softer.
  Moduli bound() const { return moduli; }

  /// The length above which an element would snap back, 2 E G_f / f_t², m.
  double most_length() const {
    return 2.0 * moduli.young() * fracture_energy / (tensile_strength * tensile_strength);
  }

  /// @param length  characteristic length h of the element, m; kept in the history
  /// @throws InputError when the element is too large for the fracture energy
  std::array<double, history> initial_history(double length) const;

  /// @param stress   Pa; at the start, turned with the material, and at the end
  /// @param kept  the history: as initial_history() made it
  /// @returns elastic energy that damage released, by the trapezoidal rule, J/m³; never negative
  template <class Math, int dim>
  [[gnu::always_inline]] typename Math::Number
  update(Symmetric<typename Math::Number, dim>& stress, typename Math::Number* kept,
         const Symmetric<typename Math::Number, dim>& strain_increment,
         double /*time_step*/) const {
    using Number = typename Math::Number;
    const Number before = kept[0];
    const auto sound_before = (1.0 / (1.0 - before)) * stress;
    const auto sound = sound_before + moduli.stress(strain_increment);
    const Number I1 = trace(sound), weighted = (strength_ratio - 1.0) * I1;
    const Number root = Math::square_root(weighted * weighted +
                                          12.0 * strength_ratio * half_square(deviator(sound)));
    const double E = moduli.young(), first = tensile_strength / E; // k_0
    const Number strain = (weighted + root) * (0.5 / (strength_ratio * E));
    const auto grows = strain > Math::larger(kept[1], Math::constant(first));
    stress = (1.0 - before) * sound;
    if (!Math::any(grows))
      return Number{};

    const Number softening = fracture_energy / (tensile_strength * kept[2]) - 0.5 * first; // k_s
    const Number target = 1.0 - first / strain * Math::exponential((first - strain) / softening);
    const Number after = Math::larger(
        before, Math::smaller(Math::select(grows, target, before), Math::constant(most_damage)));
    kept[0] = after;
    kept[1] = Math::select(grows, strain, kept[1]);
    stress = (1.0 - after) * sound;
    return 0.5 * (after - before) * (energy<dim>(sound_before) + energy<dim>(sound));
  }

private:
  template <class Tensor> [[gnu::always_inline]] static auto half_square(const Tensor& s) {
    return 0.5 * contract(s, s);
  }
  /// Elastic energy of a stress, J/m³.
  template <int dim, class Number>
  [[gnu::always_inline]] Number energy(const Symmetric<Number, dim>& sound) const {
    const Number p = (1.0 / 3.0) * trace(sound);
    return half_square(deviator(sound)) * (0.5 / moduli.mu) + p * p * (0.5 / moduli.bulk());
  }
};

} // namespace kerf::fem
