// The stress that answers a deformation: by an inlined law, or by a call.
#pragma once

#include "fem_core/kernels/element_vector.hpp"
#include "fem_core/laws/gradient.hpp"
#include "fem_core/laws/lane_math.hpp"

namespace kerf::KERF_ISA {

/// One point of a vector of elements, for a law that is called.
template <int dim> struct LawPoint {
  Tensor<dim> strain; // or its increment
  Tensor<dim> stress; // in: stored, turned to the middle of the step; out: of this strain
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

KERF_INLINE void book(const WorkLanes& work, PatchView& view) {
  view.work.internal += total(work.internal);
  view.work.dissipated += total(work.dissipated);
  view.work.hourglass += total(work.hourglass);
  view.work.viscous += total(work.viscous);
}

/// Isotropic and linear, small strain.
struct ElasticResponse {
  template <class Elements, int dim>
  KERF_INLINE static Tensor<dim> stress(const Elements& e, int, Deformation<dim>& d,
                                        PointForce<dim>& f, WorkLanes& work) {
    const Tensor<dim> stress = e.view.moduli.stress(d.strain);
    if (e.view.wants_energy)
      work.internal += only(0.5 * f.volume * contract(stress, d.strain), e.count);
    return stress;
  }
};

KERF_INLINE fem::Gradient<Lanes, 2> gradient_of(const Deformation<2>& d) {
  const auto& g = d.gradient.m;
  return {d.factor * g[0][0], d.factor * g[0][1], d.factor * g[1][0], d.factor * g[1][1],
          d.strain[2]};
}
KERF_INLINE fem::Gradient<Lanes, 3> gradient_of(const Deformation<3>& d) {
  const auto& g = d.gradient.m;
  return {d.factor * g[0][0], d.factor * g[0][1], d.factor * g[0][2],
          d.factor * g[1][0], d.factor * g[1][1], d.factor * g[1][2],
          d.factor * g[2][0], d.factor * g[2][1], d.factor * g[2][2]};
}

/// A law of the deformation gradient; gives the Kirchhoff stress.
template <class Law> struct HyperelasticResponse {
  template <class Elements, int dim>
  KERF_INLINE static Tensor<dim> stress(const Elements& e, int, Deformation<dim>& d,
                                        PointForce<dim>& f, WorkLanes& work) {
    const auto& law = *static_cast<const Law*>(e.view.law.parameters);
    const auto H = gradient_of(d);
    if (e.view.wants_energy)
      work.internal += only(f.volume * law.template energy_density<LaneMath, dim>(H), e.count);
    return law.template kirchhoff<LaneMath, dim>(H);
  }
};

/// Pressure against the rate of the volume: linear, and in compression quadratic too, which smears
/// shocks over some elements; J. von Neumann and R. D. Richtmyer, doi:10.1063/1.1699639, and
/// R. Landshoff (1955). It is not stored.
template <class Elements, int dim>
KERF_INLINE void add_bulk_viscosity(const Elements& e, const Deformation<dim>& d,
                                    const PointForce<dim>& f, Tensor<dim>& stress,
                                    WorkLanes& work) {
  const PatchView& view = e.view;
  if (view.time_step == 0.0)
    return;
  const Lanes rate = (1.0 / view.time_step) * d.own_trace; // 1/s
  const Lanes length = load(view.length + place(e.first, 1));
  const Lanes squeezed = select(rate < 0.0, length * rate, Lanes{}); // m/s
  const Lanes tension = view.constants.linear_viscosity * length * rate -
                        view.constants.quadratic_viscosity * squeezed * squeezed;
  const Lanes J = f.end / f.volume;
  for (int k = 0; k < 3; ++k)
    stress[k] += J * tension;
  work.viscous += only(f.end * tension * d.own_trace, e.count);
}

/// A law of increments, or of total strain without an inlined variant. With a rate the stress is
/// Kirchhoff's, whose Jaumann rate leaves the stiffness of a body under stress symmetric.
template <Kinematics kinematics> struct CalledResponse {
  template <class Elements, int dim>
  KERF_INLINE static Tensor<dim> stress(const Elements& e, int q, Deformation<dim>& d,
                                        PointForce<dim>& f, WorkLanes& work) {
    constexpr int size = Tensor<dim>::size;
    const PatchView& view = e.view;
    LawPoint<dim> point;
    point.strain = d.strain;
    point.time_step = view.time_step;
    point.history = view.history + e.at(q, view.law.history);
    if (view.stress == nullptr) {
      reinterpret_cast<LawCall<dim>>(view.law.respond)(view.law.parameters, point);
      if (view.wants_energy)
        work.internal += only(0.5 * f.volume * contract(point.stress, d.strain), e.count);
      return point.stress;
    }
    double* const stored = view.stress + e.at(q, size);
    Tensor<dim> mean;
    for (int k = 0; k < size; ++k)
      mean[k] = load(stored + k * batch_size);
    Matrix<dim> half_turn;
    if constexpr (kinematics == Kinematics::rate) {
      half_turn = half_turn_of<dim>(d.gradient, d.factor);
      turn<dim>(mean, half_turn);
    }
    point.stress = mean;
    reinterpret_cast<LawCall<dim>>(view.law.respond)(view.law.parameters, point);
    for (int k = 0; k < size; ++k)
      mean[k] = 0.5 * (mean[k] + point.stress[k]);
    if constexpr (kinematics == Kinematics::rate)
      turn<dim>(point.stress, half_turn);
    for (int k = 0; k < size; ++k)
      store(stored + k * batch_size, point.stress[k]);
    // The pressure works on the element's own dilatation; see nodal_pressure.hpp.
    const Lanes power =
        contract(mean, d.strain) + (1.0 / 3.0) * trace(mean) * (d.own_trace - trace(d.strain));
    work.internal += only(f.volume * power, e.count);
    work.dissipated += only(f.volume * point.dissipated, e.count);
    if (view.length != nullptr)
      add_bulk_viscosity(e, d, f, point.stress, work);
    return point.stress;
  }
};

} // namespace kerf::KERF_ISA
