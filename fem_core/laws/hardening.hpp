// How the yield stress of a metal grows with plastic strain, and with its rate.
#pragma once

#include <span>

namespace kerf::fem {

/// sigma_y(p) = sigma_0 + H p + Q (1 - exp(-b p)), or a table with straight lines between its
/// points and a constant behind the last; p is the equivalent plastic strain. It never falls.
struct Hardening {
  static constexpr int most_points = 32;

  double initial = 0.0;                                      // sigma_0, Pa
  double modulus = 0.0;                                      // H, Pa
  double saturation = 0.0;                                   // Q, Pa
  double exponent = 0.0;                                     // b
  int points = 0;                                            // of the table; none: the formula
  double strain[most_points] = {}, stress[most_points] = {}; // Pa
  double slope[most_points] = {};                            // behind each point, Pa

  /// H >= 0, Pa; zero: perfect plasticity.
  /// @throws InputError unless sigma_0 > 0 and H >= 0
  static Hardening linear(double yield_stress, double modulus);

  /// @throws InputError unless sigma_0 > 0, Q >= 0, b > 0 and H >= 0
  /// @see Voce, J. Inst. Metals 74 (1948) 537-562
  static Hardening voce(double yield_stress, double saturation, double exponent,
                        double modulus = 0.0);

  /// @param strain  equivalent plastic strain, from zero upwards
  /// @param stress  yield stress there, Pa, positive, never falling
  /// @throws InputError otherwise, or when the sizes differ or are not from 1 to 32
  static Hardening table(std::span<const double> strain, std::span<const double> stress);

  /// Whether sigma_y is one straight line.
  [[gnu::always_inline]] bool straight() const { return points == 0 && saturation == 0.0; }

  /// sigma_y at p, Pa, and its derivative.
  template <class Math>
  [[gnu::always_inline]] void evaluate(const typename Math::Number& p, typename Math::Number& yield,
                                       typename Math::Number& tangent) const {
    if (points > 0) {
      yield = stress[0] + slope[0] * p;
      tangent = Math::constant(slope[0]);
      for (int k = 1; k < points; ++k) {
        yield = Math::select(p < strain[k], yield, stress[k] + slope[k] * (p - strain[k]));
        tangent = Math::select(p < strain[k], tangent, Math::constant(slope[k]));
      }
      return;
    }
    yield = initial + modulus * p;
    tangent = Math::constant(modulus);
    if (saturation > 0.0) {
      const typename Math::Number left = saturation * Math::exponential(-exponent * p);
      yield = yield + (saturation - left);
      tangent = tangent + exponent * left;
    }
  }
};

/// The yield stress grows by the factor 1 + (rate / D)^(1/q) with the rate of the equivalent
/// plastic strain.
/// @see Cowper & Symonds, Brown University, Division of Applied Mathematics report 28 (1957)
struct RateDependence {
  double reference = 0.0; // D, 1/s; zero: none
  double exponent = 1.0;  // q

  /// @throws InputError unless D > 0 and q >= 1
  static RateDependence cowper_symonds(double reference_rate, double exponent);
};

} // namespace kerf::fem
