// What the kernels of the internal forces see of a patch of elements: pointers and plain numbers.
#pragma once

#include "fem_core/laws/moduli.hpp"
#include "fem_core/shape.hpp"

#include <cstddef>
#include <cstdint>

namespace kerf::fem {

/// Elements are stored and computed this many side by side, whatever the processor.
inline constexpr int batch_size = 8;

/// Numbers in the row of a node: in 3D a fourth fills it.
template <int dim> inline constexpr int row_size = dim == 2 ? 2 : 4;

/// What deforms. The out-of-plane direction of 2D is plane (strain zz comes from the law, if any)
/// or the hoop of axisymmetry: x is the radius, and everything counts for the whole ring.
enum class Space : std::uint8_t { plane, axisymmetric };

/// How the strain of an element is taken.
enum class Formulation : std::uint8_t {
  full,            // at every Gauss point
  mean_dilatation, // B-bar: the volumetric part is the mean of the element
  one_point,       // the mean gradient, with hourglass control; quad4 and hex8
  nodal_pressure,  // the volumetric part is averaged over the nodes; tri3 and tet4
};

enum class Kinematics : std::uint8_t {
  small, // strain is linear in the motion, on the reference configuration
  total, // hyperelastic law of the deformation gradient from the reference configuration
  rate,  // strain increments on the configuration in the middle of a step, stress turned along
};

/// A law for the kernels: one call does one point of several elements.
struct PointLaw {
  const void* parameters;
  void (*respond)(); // a LawCall<dim> of the set of instructions that is in use
  int history;       // numbers a point besides the stress
  int thickness;     // which of them is the strain through a thickness that changes; -1: none
};

/// Constants of all elements of a material.
struct ElementConstants {
  double hourglass;           // stiffness against hourglass modes, as stiffness_of() has it, Pa
  double linear_viscosity;    // of the bulk, b_1 rho c_P, Pa s/m
  double quadratic_viscosity; // b_2² rho, kg/m³
};

/// Work of a step, added up over a patch, J.
struct ElementWork {
  double internal;   // of the stress; or the elastic energy, if that is asked for
  double dissipated; // of that: plastic, damage
  double hourglass;
  double viscous; // of bulk viscosity
};

/// One patch. Rows are those of the patch's own nodes, see Patches.
struct PatchView {
  std::size_t num_elements;
  const std::uint16_t* nodes; // [batches][nodes_of(shape)][batch_size] where the row begins
  const double* reference;    // [rows] X; with Kinematics::rate x at the end of the increment, m
  const double* motion;       // [rows] u, m; for increments and rates v, m/s
  double motion_scale;        // times the motion is the displacement (increment): 1 or time_step
  double* force;              // [rows] internal forces are taken off, N
  const double* alpha;        // [batches][points][batch_size] share; null: one everywhere
  const double* length;       // [batches][batch_size] of the elements, for bulk viscosity, m
  const double* dilatation;   // [rows] mean of the elements around each node; of nodal_pressure
  double* stress;             // [batches][points][components][batch_size], Pa; null: not stored
  double* history;            // [batches][points][law.history][batch_size]
  double* hourglass;          // [batches][modes][dim][batch_size] forces of Kinematics::rate, N
  double time_step;           // of the increment, s; 0: none has been
  bool wants_energy;          // of laws of total strain
  PointLaw law;
  Moduli moduli; // of linear elasticity in small strain
  ElementConstants constants;
  ElementWork work; // is added to
};

using PatchKernel = void (*)(PatchView&);

/// How the kernels get at the law.
enum class Response : std::uint8_t {
  elastic,      // Kinematics::small, PatchView::moduli
  hyperelastic, // Kinematics::total; parameters are a NeoHookean, or one in plane stress
  hyperelastic_plane_stress,
  called,
  none, // only the dilatation of the nodes, of nodal_pressure
};

/// Which kernel.
struct KernelKey {
  Shape shape;
  Formulation formulation;
  Kinematics kinematics;
  Space space;
  Response response;
};

/// Which function a called law is. They are in the order of the variant fem::Law.
struct LawKey {
  std::size_t law;
  int dim;
  bool plane_stress;
  bool increments;
};

} // namespace kerf::fem
