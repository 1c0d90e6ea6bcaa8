// Kernels of the hex8. Compiled once for every set of instructions.
#include "fem_core/kernels/kernel_table.hpp"

namespace kerf::KERF_ISA {
template PatchKernel kernel_of_shape<Shape::hex8>(const KernelKey&);
}
