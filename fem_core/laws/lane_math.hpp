// Mathematics of several points side by side: what a material law computes with in a kernel.
// Included like common/lanes.hpp, in files that are compiled once for every set of instructions.
#pragma once

#include "common/lanes.hpp"

#include <cfloat>

namespace kerf::KERF_ISA {

/// The policy for lanes; see fem::ScalarMath. Logarithm and exponential are those of fdlibm
/// (Sun Microsystems, 1993; e_log.c, e_exp.c) with the branches taken out: the error is below two
/// units in the last place where argument and result are normal numbers.
struct LaneMath {
  using Number = Lanes;
  using Truth = Mask;
  using Bits = std::uint64_t __attribute__((vector_size(8 * width)));

  KERF_INLINE static Lanes constant(double value) { return broadcast(value); }
  KERF_INLINE static bool any(const Mask& truth) { return KERF_ISA::any(truth); }
  KERF_INLINE static Lanes select(const Mask& truth, const Lanes& yes, const Lanes& no) {
    return KERF_ISA::select(truth, yes, no);
  }
  KERF_INLINE static Lanes smaller(const Lanes& a, const Lanes& b) { return select(a < b, a, b); }
  KERF_INLINE static Lanes larger(const Lanes& a, const Lanes& b) { return select(a > b, a, b); }
  KERF_INLINE static Lanes absolute(const Lanes& x) { return KERF_ISA::absolute(x); }
  KERF_INLINE static Lanes square_root(const Lanes& x) { return KERF_ISA::square_root(x); }

  /// NaN unless x is positive, normal and finite.
  KERF_INLINE static Lanes logarithm(const Lanes& x) {
    constexpr std::uint64_t one = 0x3ff0000000000000, half_root = 0x3fe6a09e00000000; // sqrt(1/2)
    const Bits bits = (Bits)x + (one - half_root); // x = 2^k (1 + f), f from -0.29 to 0.41
    const Lanes k = (Lanes)((bits >> 52) | 0x4330000000000000) - (0x1p52 + 1023.0);
    const Lanes f = (Lanes)((bits & 0x000fffffffffffff) + half_root) - 1.0;
    const Lanes s = f / (2.0 + f), z = s * s, w = z * z; // log(1 + f) = 2 s + 2/3 s^3 + ...
    const Lanes even = w * (3.999999999940941908e-01 +
                            w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
    const Lanes odd = z * (6.666666666666735130e-01 +
                           w * (2.857142874366239149e-01 +
                                w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
    const Lanes half = 0.5 * f * f;
    const Lanes result = s * (half + (even + odd)) + k * ln2_low - half + f + k * ln2_high;
    return select((x >= DBL_MIN) & (x <= DBL_MAX), result, broadcast(__builtin_nan("")));
  }
  KERF_INLINE static Lanes logarithm_of_one_plus(const Lanes& x) {
    const Lanes u = 1.0 + x;
    return logarithm(u) + (x - (u - 1.0)) / u; // with what rounding took from u
  }
  /// Zero where the result would be below the normal numbers.
  KERF_INLINE static Lanes exponential(const Lanes& x) {
    constexpr double rounder = 0x1.8p52; // leaves an integer k in the last bits
    const Lanes shifted = x * 1.44269504088896338700 + rounder, k = shifted - rounder;
    const Lanes high = x - k * ln2_high, low = k * ln2_low, r = high - low, t = r * r;
    const Lanes c =
        r - t * (1.66666666666666019037e-01 +
                 t * (-2.77777777770155933842e-03 +
                      t * (6.61375632143793436117e-05 +
                           t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
    const Lanes of_rest = 1.0 + (r * c / (2.0 - c) - low + high);
    const Lanes result = (Lanes)((Bits)of_rest + ((Bits)shifted << 52)); // times 2^k
    return select(x > 709.782712893384, broadcast(__builtin_inf()),
                  select(x < -708.396418532264, Lanes{}, result));
  }
  KERF_INLINE static Lanes power(const Lanes& x, double y) { return exponential(y * logarithm(x)); }

private:
  static constexpr double ln2_high = 6.93147180369123816490e-01;
  static constexpr double ln2_low = 1.90821492927058770002e-10;
};

} // namespace kerf::KERF_ISA
