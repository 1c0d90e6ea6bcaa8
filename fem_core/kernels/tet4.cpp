// Kernels of the tet4. Compiled once for every set of instructions.
#include "fem_core/kernels/kernel_table.hpp"

namespace kerf::KERF_ISA {
template PatchKernel kernel_of_shape<Shape::tet4>(const KernelKey&);
}
