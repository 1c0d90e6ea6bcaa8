// Central differences in time. Every array has one number for each component of each node.
#pragma once

#include <span>

namespace kerf::fem {

/// Forces and inverse masses of a step.
struct Loads {
  std::span<const double> own;          // resultant without the interface force, N
  std::span<const double> interface;    // force of the couplings, N
  std::span<const double> inverse_mass; // 1/kg; 0: moves with the velocity it has
};

/// v^(-1/2) = v^0 - a dt/2, in place: so that the first step has v^(1/2) = v^0 + a dt/2.
void step_back_half(const Loads& loads, double time_step, std::span<double> velocity);

/// a = F/m, v^(n+1/2) = v^(n-1/2) + a dt, u^(n+1) = u^n + v^(n+1/2) dt; Rojek (2008) eqs 3-5.
///
/// @param velocity, displacement            v^(n-1/2), m/s, and u^n, m
/// @param next_velocity, next_displacement  receive v^(n+1/2) and u^(n+1)
void advance(const Loads& loads, double time_step, std::span<const double> velocity,
             std::span<const double> displacement, std::span<double> next_velocity,
             std::span<double> next_displacement);

} // namespace kerf::fem
