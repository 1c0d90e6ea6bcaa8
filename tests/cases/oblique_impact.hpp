// Theory of the oblique impact of two equal elastic spheres of one material.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace kerf::cases {

/// Everything is in units in which E* = R* = m* = v_n = 1, friction = 1; psi scales velocities of
/// the contact point.
/// @see N. Maw, J.R. Barber & J.N. Fawcett, Wear 38 (1976) 101, doi:10.1016/0043-1648(76)90201-2
struct ObliqueImpact {
  double poisson_ratio = 0.0;

  /// psi over tangential per (friction times normal) velocity.
  double psi_scale() const { return 2.0 * (1.0 - poisson_ratio) / (2.0 - poisson_ratio); }
  double chi() const { return 0.5 * psi_scale() * turning; }

  /// psi_2 of the solution with annuli that slip. A contact that is loaded along one tangential
  /// direction has the forces of independent springs on a line, with the profile x²/R, each with
  /// its own friction (V.L. Popov & M. Hess, Method of Dimensionality Reduction, 2015; for impacts
  /// I.A. Lyashenko & V.L. Popov, Sci. Rep. 5 (2015) 8479, doi:10.1038/srep08479).
  double rebound(double psi_1) const {
    constexpr int springs = 400;
    const double width = 1.001 * std::sqrt(largest_overlap()) / springs;
    std::vector<double> slip(springs, 0.0); // tangential stretch of each spring
    return rebound(psi_1, [&](double overlap, double move) {
      double force = 0.0;
      for (int i = 0; i < springs; ++i) {
        const double x = (i + 0.5) * width, pressed = overlap - x * x;
        auto& u = slip[static_cast<std::size_t>(i)];
        const double limit = std::max(0.0, pressed) / tangential_modulus();
        u = std::clamp(u + move, -limit, limit);
        force += 2.0 * width * tangential_modulus() * u;
      }
      return force;
    });
  }

  /// psi_2 of one spring of Mindlin's stiffness without slip, which slides as a whole and whose
  /// force fades with the stiffness while the contact is released.
  double rebound_of_one_spring(double psi_1) const {
    double force = 0.0, before = 0.0;
    return rebound(psi_1, [=, this](double overlap, double move) mutable {
      const double a = std::sqrt(std::max(0.0, overlap));
      if (a < before)
        force *= a / before;
      before = a;
      const double limit = 4.0 / 3.0 * a * a * a;
      force = std::clamp(force + 2.0 * tangential_modulus() * a * move, -limit, limit);
      return force;
    });
  }

private:
  static constexpr double turning = 3.5; // 1 + m r² / I of spheres

  double largest_overlap() const { return std::pow(15.0 / 16.0, 0.4); }
  /// G-like modulus over E*: Mindlin's stiffness is 2 a of it, 4 a G / (2 - nu).
  double tangential_modulus() const { return psi_scale(); }

  /// Central differences with the force of a law of (overlap, move of the contact point).
  template <class Law> double rebound(double psi_1, Law law) const {
    constexpr int steps = 8000; // of about one impact
    const double dt = 2.95 * largest_overlap() / steps;
    double overlap = 0.0, approach = 1.0, slide = psi_1 / psi_scale();
    do {
      overlap += dt * approach;
      const double tangential = law(overlap, dt * slide);
      approach -= dt * 4.0 / 3.0 * std::pow(std::max(0.0, overlap), 1.5);
      slide -= dt * turning * tangential;
    } while (overlap > 0.0);
    return slide * psi_scale();
  }
};

} // namespace kerf::cases
