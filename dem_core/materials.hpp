// The materials of a body, and what counts for contacts between two of them.
#pragma once

#include "dem_core/contact_view.hpp"
#include "dem_core/particles.hpp"
#include "dem_core/settings.hpp"

#include <span>
#include <vector>

namespace kerf::dem {

/// @throws std::invalid_argument when a constant is out of its range or two exclude one another
void check(const Material& material);

/// Contacts between particles of two materials.
struct Mixture {
  Material first, second; // of the particles, in their order
  Material both;          // all but linear springs between unlike materials, which need the sizes
  bool bonds = true;      // may there be any

  bool is_of_one_kind() const { return first == second; }
  bool is_hertzian() const { return both.law == NormalLaw::hertz_mindlin; }
};

/// Unless a pair of the settings says otherwise, the particles of two materials are springs in
/// series: each has half of the compliance that a contact with its like has, in both directions.
/// Spheres of Hertz and Mindlin have 1/E* = sum of (1 - nu²)/E and 1/G* = sum of 2 (2 - nu)(1 +
/// nu)/E. Of friction, rolling friction, restitution, strengths and radius of bonds the smaller
/// counts.
/// @see Ip2_FrictMat_FrictMat_FrictPhys of YADE: V. Smilauer et al. (2021),
/// doi:10.5281/zenodo.5705394
class Materials {
public:
  Materials() = default;
  /// @throws std::invalid_argument when a material cannot be, materials of two laws have no pair,
  /// or
  ///         a pair is given twice
  Materials(Material one, std::span<const Material> others = {},
            std::span<const MaterialPair> pairs = {});

  const std::vector<Material>& all() const noexcept { return all_; }
  bool is_one() const noexcept { return all_.size() == 1; }
  template <int dim> const Material& of(const Particles<dim>& particles, std::size_t i) const {
    return is_one() ? all_[0] : all_[particles.material[i]];
  }
  template <int dim>
  const Mixture& between(const Particles<dim>& p, std::size_t i, std::size_t j) const {
    return is_one() ? mixtures_[0] : mixture(p.material[i], p.material[j]);
  }
  const Mixture& mixture(std::size_t first, std::size_t second) const {
    return mixtures_[first * all_.size() + second];
  }
  std::span<const Mixture> mixtures() const noexcept { return mixtures_; }

  bool may_bond() const;         // some pair of particles
  bool has_hertzian() const;     // contacts
  ContactLaw linear_law() const; // of bonds and linear contacts: the one that all of them need

  /// Of all contacts without a bond.
  void set_friction(double friction);

private:
  std::vector<Material> all_;
  std::vector<Mixture> mixtures_; // [all][all]
};

/// Gives every particle its material, and the density and mass of it.
/// @param material_of  [n] index of each; empty: there is one material
/// @throws std::invalid_argument when the size is wrong or there is no such material
template <int dim>
void set_materials(Particles<dim>& particles, std::span<const std::uint8_t> material_of,
                   const Materials& materials);

} // namespace kerf::dem
