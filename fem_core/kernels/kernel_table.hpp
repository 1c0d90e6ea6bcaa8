// Chooses the kernel of one shape.
#pragma once

#include "fem_core/kernels/kernels.hpp"
#include "fem_core/laws/plane_stress.hpp"

namespace kerf::KERF_ISA {

using fem::Formulation;
using fem::KernelKey;
using fem::PatchKernel;

/// Null when there is no such kernel.
template <Shape shape, Kinematics kinematics, Space space, class Respond>
PatchKernel kernel_of_formulation(Formulation formulation) {
  if (formulation == Formulation::full)
    return full_kernel<shape, kinematics, space, Respond>;
  if constexpr (shape == Shape::tri3 || shape == Shape::tet4) {
    if constexpr (kinematics != Kinematics::total)
      if (formulation == Formulation::nodal_pressure)
        return nodal_pressure_kernel<shape, kinematics, space, Respond>;
  } else {
    if constexpr (kinematics != Kinematics::total)
      if (formulation == Formulation::mean_dilatation)
        return mean_dilatation_kernel<shape, kinematics, space, Respond>;
    if constexpr (space == Space::plane)
      if (formulation == Formulation::one_point)
        return one_point_kernel<shape, kinematics, Respond>;
  }
  return nullptr;
}

template <Shape shape, Space space> PatchKernel kernel_of_space(const KernelKey& key) {
  using fem::Response;
  const Formulation formulation = key.formulation;
  if constexpr (shape == Shape::tri3 || shape == Shape::tet4)
    if (key.response == Response::none)
      return key.kinematics == Kinematics::rate
                 ? dilatation_kernel<shape, Kinematics::rate, space>
                 : dilatation_kernel<shape, Kinematics::small, space>;
  switch (key.kinematics) {
  case Kinematics::rate:
    return kernel_of_formulation<shape, Kinematics::rate, space, CalledResponse<Kinematics::rate>>(
        formulation);
  case Kinematics::total:
    if constexpr (ShapeOf<shape>::dim == 2 && space == Space::plane)
      if (key.response == Response::hyperelastic_plane_stress)
        return kernel_of_formulation<shape, Kinematics::total, space,
                                     HyperelasticResponse<fem::PlaneStress<fem::NeoHookean>>>(
            formulation);
    return kernel_of_formulation<shape, Kinematics::total, space,
                                 HyperelasticResponse<fem::NeoHookean>>(formulation);
  case Kinematics::small:
    break;
  }
  if (key.response == Response::called)
    return kernel_of_formulation<shape, Kinematics::small, space,
                                 CalledResponse<Kinematics::small>>(formulation);
  return kernel_of_formulation<shape, Kinematics::small, space, ElasticResponse>(formulation);
}

template <Shape shape> PatchKernel kernel_of_shape(const KernelKey& key) {
  if constexpr (ShapeOf<shape>::dim == 2)
    if (key.space == Space::axisymmetric)
      return kernel_of_space<shape, Space::axisymmetric>(key);
  return kernel_of_space<shape, Space::plane>(key);
}

} // namespace kerf::KERF_ISA
