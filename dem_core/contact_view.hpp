// What the kernels of the contact forces see of the contacts: pointers and plain numbers.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kerf::dem {

/// Which kernel computes a contact: linear has neither dashpots nor moments and is the fast one.
enum class ContactLaw : std::uint8_t { linear, linear_with_moments, hertz_mindlin };

enum class BreakMode : std::uint8_t { tension, shear };

/// Contacts go through a kernel in chunks of this many.
inline constexpr int chunk_size = 64;

/// A constant of the contacts: one for all, or one for each.
struct ContactConstant {
  const double* each; // null: `all` counts
  double all;
};

/// The contacts of one block and the particles they join. The kernels are compiled once for every
/// set of instructions and must not share inline functions with anything else, hence no classes.
template <int dim> struct ContactView {
  static constexpr int shear_components = dim == 2 ? 1 : 3;

  std::size_t begin, loose, end; // contacts of this block; what has or had a bond comes first

  // One entry a contact; see Contacts.
  const std::uint32_t *first, *second, *target;
  const double* reference_branch[dim];
  const double *rest_length, *share;
  ContactConstant normal_stiffness, tangential_stiffness, tensile_strength, shear_strength;
  ContactConstant friction, weight;
  // Of dashpots and moments; not read by ContactLaw::linear.
  ContactConstant normal_viscosity, tangential_viscosity;
  ContactConstant bending_stiffness, twisting_stiffness, bond_lever, rolling_limit;
  std::uint8_t* bonded;
  double* normal_force;
  double* shear[shear_components];
  double* moment[shear_components];

  double travelled;    // see Increment, m
  double* clear_until; // of each chunk from `loose` on: nobody touches until then, m

  // A row of four (3D) or dim numbers a particle, a rotation in 2D is one.
  const double *displacement, *translation, *rotation;
  double scale; // of translation and rotation
  double rate;  // of the increment, one over its time, 1/s; 0: it took none
  double half;  // where the slip is measured: 0.5 in the middle of the increment, 0 at its end

  double* loads; // rows of 4 (2D) or 8 (3D): force, moment

  double friction_loss, fracture_loss, viscous_loss; // are added to, J
  void (*on_break)(void* list, std::uint32_t contact, BreakMode mode, double energy);
  void* breaks; // the list
};

/// Adds forces and moments of the contacts of a view to the loads, and follows their history.
template <int dim> using ContactKernel = void (*)(ContactView<dim>&);

} // namespace kerf::dem
