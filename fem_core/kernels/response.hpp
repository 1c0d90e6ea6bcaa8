// The stress that answers a deformation: by an inlined law, or by a call.
#pragma once

#include "fem_core/kernels/element_vector.hpp"

namespace kerf::KERF_ISA {

/// One point of a vector of elements, for a law that is called.
template <int dim> struct LawPoint {
  Tensor<dim> strain; // or its increment
  Tensor<dim> stress; // in: stored, already turned; out: of this strain
  Lanes dissipated;   // out: work density of the increment, J/m³
  double* history;    // [law.history][batch_size], the first of these lanes
  double time_step;   // s
};
template <int dim> using LawCall = void (*)(const void* parameters, LawPoint<dim>& point);

/// Sums over the lanes of a patch, kept as lanes until its end.
struct WorkLanes {
  Lanes internal{}, dissipated{}, hourglass{}, viscous{};
};

/// The first `count` lanes; the others are zero.
KERF_INLINE Lanes only(const Lanes& x, int count) {
  Lanes result = x;
  for (int l = 0; l < width; ++l)
    if (l >= count)
      result[l] = 0.0;
  return result;
}

/// Isotropic and linear, small strain: lambda tr(eps) 1 + 2 mu eps.
struct ElasticResponse {
  template <class Elements, int dim>
  KERF_INLINE static Tensor<dim> stress(const Elements& e, int, Deformation<dim>& d,
                                        const PointForce<dim>& f, WorkLanes& work) {
    const Lanes pressure = e.view.constants.lambda * trace(d.strain);
    const double twice_mu = 2.0 * e.view.constants.mu;
    Tensor<dim> s;
    for (int k = 0; k < Tensor<dim>::size; ++k)
      s[k] = twice_mu * d.strain[k];
    for (int k = 0; k < 3; ++k)
      s[k] += pressure;
    if (e.view.wants_energy)
      work.internal += only(0.5 * f.volume * contract(s, d.strain), e.count);
    return s;
  }
};

/// A law of increments, or of total strain without an inlined variant.
template <Kinematics kinematics> struct CalledResponse {
  template <class Elements, int dim>
  KERF_INLINE static Tensor<dim> stress(const Elements& e, int q, Deformation<dim>& d,
                                        const PointForce<dim>& f, WorkLanes& work) {
    constexpr int size = Tensor<dim>::size;
    const PatchView& view = e.view;
    LawPoint<dim> point;
    point.strain = d.strain;
    point.time_step = view.time_step;
    point.history = view.history + e.at(q, view.law.history);
    double* const stored = view.stress == nullptr ? nullptr : view.stress + e.at(q, size);
    Tensor<dim> before;
    for (int k = 0; k < size; ++k)
      before[k] = stored == nullptr ? Lanes{} : load(stored + k * batch_size);
    if constexpr (kinematics == Kinematics::rate)
      turn<dim>(before, d.gradient, d.factor);
    point.stress = before;
    point.dissipated = Lanes{};
    reinterpret_cast<LawCall<dim>>(view.law.respond)(view.law.parameters, point);
    if (view.wants_energy)
      work.internal += only(0.5 * f.volume * contract(point.stress, d.strain), e.count);
    else if (stored != nullptr) {
      for (int k = 0; k < size; ++k) {
        store(stored + k * batch_size, point.stress[k]);
        before[k] += point.stress[k];
      }
      work.internal += only(0.5 * f.volume * contract(before, d.strain), e.count);
      work.dissipated += only(f.volume * point.dissipated, e.count);
    }
    return point.stress;
  }
};

} // namespace kerf::KERF_ISA
