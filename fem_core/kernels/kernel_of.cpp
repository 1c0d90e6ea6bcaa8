// Chooses the kernel of a group of elements. Compiled once for every set of instructions.
#include "fem_core/kernels/patch_view.hpp"

namespace kerf::KERF_ISA {

template <fem::Shape shape> fem::PatchKernel kernel_of_shape(const fem::KernelKey& key);

fem::PatchKernel kernel_of(const fem::KernelKey& key) {
  switch (key.shape) {
  case fem::Shape::tri3:
    return kernel_of_shape<fem::Shape::tri3>(key);
  case fem::Shape::quad4:
    return kernel_of_shape<fem::Shape::quad4>(key);
  case fem::Shape::tet4:
    return kernel_of_shape<fem::Shape::tet4>(key);
  case fem::Shape::hex8:
    break;
  }
  return kernel_of_shape<fem::Shape::hex8>(key);
}

} // namespace kerf::KERF_ISA
