// Chooses the kernel of one shape.
#pragma once

#include "fem_core/kernels/kernels.hpp"

namespace kerf::KERF_ISA {

template <Shape shape, Kinematics kinematics, Space space, class Response>
PatchKernel kernel_of_formulation(Formulation formulation) {
  if (formulation == Formulation::full)
    return full_kernel<shape, kinematics, space, Response>;
  if constexpr (shape == Shape::quad4 || shape == Shape::hex8)
    if (formulation == Formulation::mean_dilatation)
      return mean_dilatation_kernel<shape, kinematics, space, Response>;
  return nullptr;
}

template <Shape shape, Space space> PatchKernel kernel_of_space(const fem::KernelKey& key) {
  switch (key.kinematics) {
  case Kinematics::rate:
    return kernel_of_formulation<shape, Kinematics::rate, space, CalledResponse<Kinematics::rate>>(
        key.formulation);
  case Kinematics::total:
    return nullptr;
  case Kinematics::small:
    break;
  }
  if (key.called_law)
    return kernel_of_formulation<shape, Kinematics::small, space,
                                 CalledResponse<Kinematics::small>>(key.formulation);
  return kernel_of_formulation<shape, Kinematics::small, space, ElasticResponse>(key.formulation);
}

template <Shape shape> PatchKernel kernel_of_shape(const fem::KernelKey& key) {
  if constexpr (ShapeOf<shape>::dim == 2)
    if (key.space == Space::axisymmetric)
      return kernel_of_space<shape, Space::axisymmetric>(key);
  return kernel_of_space<shape, Space::plane>(key);
}

} // namespace kerf::KERF_ISA
