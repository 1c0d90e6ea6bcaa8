// The list of contacts with their history, and the kinematics of one contact.
#pragma once

#include "dem_core/contact_view.hpp"
#include "dem_core/materials.hpp"
#include "dem_core/neighbours.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/settings.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kerf::dem {

/// Vectors stored component by component, as the kernels read them.
template <int size> struct Columns {
  std::array<std::vector<double>, size> of;

  void resize(std::size_t count) {
    for (std::vector<double>& column : of)
      column.resize(count);
  }
  Eigen::Matrix<double, size, 1> operator[](std::size_t k) const {
    Eigen::Matrix<double, size, 1> vector;
    for (std::size_t a = 0; a < size; ++a)
      vector[static_cast<Eigen::Index>(a)] = of[a][k];
    return vector;
  }
  void set(std::size_t k, const Eigen::Matrix<double, size, 1>& vector) {
    for (std::size_t a = 0; a < size; ++a)
      of[a][k] = vector[static_cast<Eigen::Index>(a)];
  }
};

/// A constant of the contacts: one number for all of them until they differ.
class PerContact {
public:
  double operator[](std::size_t k) const noexcept { return each_.empty() ? all_ : each_[k]; }
  bool is_uniform() const noexcept { return each_.empty(); }
  double all() const noexcept { return all_; }
  std::span<const double> each() const noexcept { return each_; }

  void set_all(double value) {
    all_ = value;
    each_.clear();
  }
  void set_each(std::vector<double> values) { each_ = std::move(values); }

private:
  double all_ = 0.0;
  std::vector<double> each_;
};

/// What contacts have dissipated so far, with weight, J.
struct ContactLosses {
  double friction = 0.0, fracture = 0.0, viscous = 0.0;
};

/// Pairs of particles that touch or soon may. The normal points from `first` to `second`, the one
/// of the larger index; tension is positive. In the list follow one another, each ascending by
/// (first, second): of each block of particles the bonds of the start, then linear and then
/// Hertzian contacts, of both first what touched when the list was made and then what did not.
template <int dim> struct Contacts {
  // One entry a contact.
  std::vector<std::uint32_t> first, second;
  Columns<dim> reference_branch;    // x_j - x_i of this image, less u_j - u_i, m
  std::vector<double> rest_length;  // centre distance without normal force, m
  std::vector<double> share;        // r_i / (r_i + r_j), part of the branch that is arm of i
  std::vector<std::uint8_t> bonded; // holds tension
  std::vector<double> normal_force; // F_n, without weight, N
  /// F_T on the first, without weight, N; in 2D along the normal turned by +90 degrees.
  Columns<rotations<dim>> shear_force;

  PerContact normal_stiffness, tangential_stiffness; // k_n, k_t, N/m
  PerContact tensile_strength, shear_strength;       // R_n, R_t, N
  PerContact friction;                               // mu without bond
  PerContact weight;                                 // w_c, one until blended

  ContactLaw law = ContactLaw::linear; // of bonds and linear contacts
  bool has_moments = false;
  // Of laws with dashpots and moments, see contact_constants.hpp.
  PerContact normal_viscosity, tangential_viscosity; // c_n, c_t, N s/m
  PerContact bending_stiffness, twisting_stiffness;  // k_b, k_w, N m
  PerContact bond_lever, rolling_limit;              // 1/m; m
  Columns<rotations<dim>> moment; // on the first, without weight, N m; empty without moments

  // A block of particles owns the contacts of which they are the first. What a contact gives to a
  // particle of another block waits in a row behind those of the particles: block by block nobody
  // writes where another one does, and the rows are added in the order of the contacts.
  std::vector<std::uint32_t> block_offset;    // [blocks + 1] contacts of each block
  std::vector<std::uint32_t> loose_offset;    // [blocks] the first that never had a bond
  std::vector<std::uint32_t> hertz_offset;    // [blocks] the first Hertzian one; the rest is, too
  std::vector<std::uint32_t> target;          // [contacts] row of the loads of the second
  std::vector<std::uint32_t> waiting_offset;  // [blocks + 1] waiting rows that each block writes
  std::vector<std::uint32_t> incoming_offset; // [blocks + 1] of what each block receives:
  std::vector<std::uint32_t> incoming_row;    // the row that waits
  std::vector<std::uint32_t> incoming_second; // the particle it is for

  std::vector<ContactLosses> losses; // [blocks]

  std::vector<double> clear_until; // what the kernels remember, see ContactView

  std::size_t size() const noexcept { return first.size(); }
  std::size_t blocks() const noexcept { return block_offset.size() - 1; }
  std::size_t waiting_rows() const noexcept { return incoming_row.size(); }
  std::size_t bonds() const noexcept; // that hold now
  /// Has or had a bond: stays in the list for ever, with its stress-free distance.
  bool was_bonded(std::size_t k) const noexcept {
    return k < loose_offset[first[k] / particles_per_block];
  }
  bool is_hertzian(std::size_t k) const noexcept {
    return k >= hertz_offset[first[k] / particles_per_block];
  }
  double memory() const; // bytes

  /// A contact carries force when it is bonded or pressed together.
  bool carries(std::size_t k, double opening) const noexcept { return bonded[k] || opening < 0.0; }
};

/// Contacts at the start: bonds where the gap is within the tolerance, each free of stress at the
/// distance it has in the reference configuration, and all other pairs within the skin.
/// @param gap_tolerance  over r_i + r_j; nothing: no bonds
/// @throws std::invalid_argument when two centres are closer than half of the sum of the radii, or
///         a period is too short
template <int dim>
Contacts<dim> make_contacts(const Particles<dim>& particles, const Materials& materials,
                            std::optional<double> gap_tolerance, double skin,
                            const Period<dim>& period);

/// Makes the list again for the current positions. What has or had a bond stays; other pairs stay
/// while they are within the skin, and keep their history.
template <int dim>
void renew_contacts(Contacts<dim>& contacts, const Particles<dim>& particles,
                    const Materials& materials, double skin, const Period<dim>& period);

/// Bonds all pairs that may with a gap of at most gap_tolerance (r_i + r_j), in a list made again.
/// Who touches keeps its force, and if it is linear its stress-free distance; across a gap a bond
/// is free of stress where it is. What a Hertzian contact has stored beyond the bond that takes its
/// place is booked as loss by fracture.
/// @return the number of new bonds
/// @throws std::invalid_argument when no materials may be bonded
template <int dim>
std::size_t bond_pairs(Contacts<dim>& contacts, const Particles<dim>& particles,
                       const Materials& materials, double gap_tolerance, double skin,
                       const Period<dim>& period);

/// Sets w_c = (r_j w_i + r_i w_j) / (r_i + r_j): 1 - alpha, which is linear, at the point of
/// contact, bounded there. One value for both sides keeps the pair of forces opposite.
template <int dim> void blend(Contacts<dim>& contacts, const Particles<dim>& particles);

/// The contacts of every particle: those of particle i are entries offset[i] to offset[i + 1], each
/// 2 k for the first and 2 k + 1 for the second particle of contact k, ascending.
struct Incidence {
  std::vector<std::uint32_t> offset, entry;
};
template <int dim> Incidence incidence(const Contacts<dim>& contacts, std::size_t particles);

/// Stiffness of a contact against small motions from where it is.
struct ContactStiffness {
  double normal = 0.0, tangential = 0.0; // N/m
  double bending = 0.0, twisting = 0.0;  // N m
};
template <int dim>
ContactStiffness stiffness_of(const Contacts<dim>& contacts, std::size_t k, double opening);

/// Where the two particles of a contact are to each other.
template <int dim> struct Span {
  Vec<dim> branch;      // from the first to the second centre, m
  double length = 0.0;  // of the branch, m
  double opening = 0.0; // u_n, > 0 is a gap, m

  Vec<dim> normal() const { return branch / length; }
};
template <int dim>
Span<dim> span_of(const Contacts<dim>& contacts, const Particles<dim>& particles, std::size_t k);

/// F_T on the first particle as a vector, without weight, N; at the positions of its update.
template <int dim>
Vec<dim> shear_force(const Contacts<dim>& contacts, const Particles<dim>& particles, std::size_t k);

/// Force on the first particle, F_n and F_T, without weight, N; eq. 11.
template <int dim>
Vec<dim> contact_force(const Contacts<dim>& contacts, const Particles<dim>& particles,
                       std::size_t k) {
  return contacts.normal_force[k] * span_of(contacts, particles, k).normal() +
         shear_force(contacts, particles, k);
}

} // namespace kerf::dem
