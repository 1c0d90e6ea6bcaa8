// The laws of a contact, one small struct each, for several contacts at a time.
#pragma once

#include "common/lanes.hpp"

namespace kerf::KERF_ISA {

/// Springs of constant stiffness: F_n = k_n u_n (Rojek (2008) eq. 12), F_T by k_t (eq. 13), and
/// dashpots of constant viscosity.
struct LinearLaw {
  static constexpr bool stiffens = false, has_bonds = true;
  KERF_INLINE static Lanes normal_force(const Lanes& k_n, const Lanes& opening) {
    return k_n * opening;
  }
  KERF_INLINE static Lanes tangential_stiffness(const Lanes& k_t, const Lanes&) { return k_t; }
  KERF_INLINE static Lanes viscosity(const Lanes& c, const Lanes&) { return c; }
};

/// Smooth elastic spheres pressed together by delta = -u_n: F_n = -k_n delta^(3/2) with
/// k_n = 4/3 E* sqrt(R*), and a tangential stiffness k_t sqrt(delta) with k_t = 8 G* sqrt(R*).
/// The dashpots follow delta^(1/4), which makes the restitution independent of the velocity.
/// @see H. Hertz, J. reine angew. Math. 92 (1881) 156; R.D. Mindlin, J. Appl. Mech. 16 (1949) 259;
///      Y. Tsuji et al., Powder Technol. 71 (1992) 239, doi:10.1016/0032-5910(92)88030-L
struct HertzMindlinLaw {
  static constexpr bool stiffens = true, has_bonds = false;
  KERF_INLINE static Lanes pressed(const Lanes& opening) {
    return select(opening < 0.0, -opening, Lanes{}); // delta, m
  }
  KERF_INLINE static Lanes normal_force(const Lanes& k_n, const Lanes& opening) {
    const Lanes delta = pressed(opening);
    return -k_n * delta * square_root(delta);
  }
  KERF_INLINE static Lanes tangential_stiffness(const Lanes& k_t, const Lanes& opening) {
    return k_t * square_root(pressed(opening));
  }
  KERF_INLINE static Lanes viscosity(const Lanes& c, const Lanes& opening) {
    return c * square_root(square_root(pressed(opening)));
  }
};

} // namespace kerf::KERF_ISA
