// Energies of a body and the books of the work that is done on it.
#pragma once

#include "fem_core/elements.hpp"
#include "fem_core/materials.hpp"

#include <span>

namespace kerf::fem {

/// Energies at t_n and the work done until then, J (per metre of thickness in 2D). In a linear run
/// kinetic + elastic - external_work - interface_work stays what it was at the start, to round-off.
struct Energies {
  double kinetic = 0.0;        // 1/2 v^(n-1/2) . M v^(n+1/2)
  double elastic = 0.0;        // 1/2 u^n . K u^n
  double external_work = 0.0;  // of the reactions where the motion is prescribed
  double interface_work = 0.0; // of the forces of the couplings
};

/// Work of the forces f_n of one step, f_n . v dt/2: with the velocity before t_n, and with the one
/// after it. Together they are the trapezoidal rule.
struct Work {
  double before = 0.0; // with v^(n-1/2), J
  double after = 0.0;  // with v^(n+1/2), J

  Work& operator+=(const Work& other) {
    before += other.before;
    after += other.after;
    return *this;
  }
};

/// The work of all steps so far.
class WorkBook {
public:
  /// The first step of a run has no time before it, and counts the second half only.
  void add(const Work& work, bool first_step) {
    at_step_ = first_step ? total_ : total_ + work.before;
    total_ = at_step_ + work.after;
  }
  /// Work done until the t_n of the step added last, J.
  double at_step() const { return at_step_; }

private:
  friend struct StateParts;

  double total_ = 0.0;   // J
  double at_step_ = 0.0; // J
};

/// 1/2 v^(n-1/2) . M v^(n+1/2), J.
/// @param mass  [num_nodes] kg; the velocities are [num_nodes][dim], m/s
template <int dim>
double kinetic_energy(std::span<const double> mass, std::span<const double> velocity_before,
                      std::span<const double> velocity_after);

/// Momentum at t_n with the mean of the velocities before and after it, N s.
template <int dim>
Vec<dim> momentum(std::span<const double> mass, std::span<const double> velocity_before,
                  std::span<const double> velocity_after);

/// Elastic energy of an element, the sum of 1/2 alpha eps : C : eps detJ over its points, J.
/// @param displacement  [num_nodes][dim] m
template <int dim>
double element_energy(const Elements<dim>& elements, const LinearElastic& material,
                      std::span<const double> displacement, std::size_t element);

/// Mean stress of the Gauss points of an element, without alpha, Pa.
template <int dim>
Tensor<dim> element_stress(const Elements<dim>& elements, const LinearElastic& material,
                           std::span<const double> displacement, std::size_t element);

/// Elastic energy of all elements, J.
template <int dim>
double elastic_energy(const Elements<dim>& elements, const LinearElastic& material,
                      std::span<const double> displacement);

} // namespace kerf::fem
