// The list of contacts with their history, and the kinematics of one contact.
#pragma once

#include "dem_core/neighbours.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// Pairs of particles that touch or soon may, ascending by (first, second). All arrays have one
/// entry a contact. The normal points from `first` to `second`; tension is positive.
template <int dim> struct Contacts {
  std::vector<std::uint32_t> first, second;
  std::vector<Vec<dim>> reference_branch; // x_j - x_i of this image, less u_j - u_i, m
  std::vector<double> reference_length;   // of reference_branch, m
  std::vector<double> rest_length;        // centre distance without normal force, m
  std::vector<double> share;              // r_i / (r_i + r_j), part of the branch that is arm of i

  std::vector<double> normal_stiffness, tangential_stiffness; // k_n, k_t, N/m
  std::vector<double> tensile_strength, shear_strength;       // R_n, R_t, N
  std::vector<double> weight;                                 // w_c in the blended virtual work

  std::vector<std::uint8_t> bonded;          // holds tension
  std::vector<std::uint8_t> bonded_at_start; // stays in the list for ever
  std::vector<double> normal_force;          // F_n, without weight, N
  std::vector<Vec<dim>> shear_force;         // F_T on the first, without weight, N
  std::vector<double> friction_loss;         // dissipated so far, with weight, J
  std::vector<double> fracture_loss;         // dissipated so far, with weight, J

  // Results of the last update, with weight.
  std::vector<Vec<dim>> force;  // on the first; the second gets the opposite, N
  std::vector<Rot<dim>> couple; // branch x force: share on the first, the rest on the second, N m

  // Contacts of particle i: entries offset[i] to offset[i + 1] of incidence, each 2 k for the
  // first and 2 k + 1 for the second particle of contact k, ascending.
  std::vector<std::uint32_t> offset, incidence;

  double lost_friction = 0.0; // friction_loss of the contacts that have left the list, J

  std::size_t size() const noexcept { return first.size(); }
  std::size_t bonds() const noexcept; // that hold now

  /// A contact carries force when it is bonded or pressed together.
  bool carries(std::size_t k, double opening) const noexcept { return bonded[k] || opening < 0.0; }
};

/// Contacts at the start: bonds where the gap is within the tolerance, each free of stress at the
/// distance it has in the reference configuration, and all other pairs within the skin.
/// @throws std::invalid_argument when two particles share a centre or a period is too short
template <int dim>
Contacts<dim> make_contacts(const Particles<dim>& particles, const Material& material,
                            double gap_tolerance, double skin, const Period<dim>& period);

/// Makes the list again for the current positions. What was bonded at the start stays, with its
/// stress-free distance; other pairs stay while they are within the skin, and keep their history.
template <int dim>
void renew_contacts(Contacts<dim>& contacts, const Particles<dim>& particles,
                    const Material& material, double skin, const Period<dim>& period);

/// Sets w_c = (r_j w_i + r_i w_j) / (r_i + r_j): 1 - alpha, which is linear, at the point of
/// contact, bounded there. One value for both sides keeps the pair of forces opposite.
template <int dim> void blend(Contacts<dim>& contacts, const Particles<dim>& particles);

/// Normal opening u_n of contact k with current branch b and relative displacement b - B, m.
/// |b| - |B| is computed from the displacement, so that it keeps its digits when it is small.
template <int dim>
double opening(const Contacts<dim>& c, std::size_t k, const Vec<dim>& relative, double length) {
  const Vec<dim>& B = c.reference_branch[k];
  const double stretch =
      relative.dot(2.0 * B + relative) / (length + c.reference_length[k]); // |b| - |B|
  return stretch + (c.reference_length[k] - c.rest_length[k]);
}

/// Turns a vector that is orthogonal to the unit vector `from` by the shortest rotation that
/// brings `from` to `to`. It keeps its length and ends orthogonal to `to`.
template <int dim> Vec<dim> turn(const Vec<dim>& vector, const Vec<dim>& from, const Vec<dim>& to) {
  return vector - (vector.dot(to) / (1.0 + from.dot(to))) * (from + to);
}

/// Turns a vector that is orthogonal to the unit vector `axis` about it, by 2 atan(angle / 2): the
/// angle up to its third power, at the price of no trigonometry, and with the length kept.
inline Vec<3> twist(const Vec<3>& vector, const Vec<3>& axis, double angle) {
  const double t = 0.5 * angle;
  return ((1.0 - t * t) * vector + 2.0 * t * axis.cross(vector)) / (1.0 + t * t);
}

} // namespace kerf::dem
