// Contacts of the particles with one rigid tool, and their history.
#pragma once

#include "dem_core/contact_forces.hpp"
#include "dem_core/tool.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::dem {

/// A particle that touches the tool. Signs are those of contacts between particles, with the tool
/// as the second body; vectors are in the frame of the tool, see Pose.
template <int dim> struct WallContact {
  std::uint32_t particle = 0;
  double rest_gap = 0.0;                   // without normal force, below zero when seated, m
  Vec<dim> arm = Vec<dim>::Zero();         // from the centre to the surface, m
  double normal_force = 0.0;               // F_n, N
  Vec<dim> shear_force = Vec<dim>::Zero(); // F_T on the particle, N
};

/// Everything happens in the frame of the tool, where its surface is at rest. The law is that of
/// contacts without bond, see compute_contact_forces(): F_n = k_n u_n in compression, the shear
/// force grows by k_t times the slip halfway through the step and slides at mu |F_n|. The arm of
/// the particle reaches from its centre to the surface, that of the tool from its reference point
/// to the same place: a rigid motion of both makes no slip, and angular momentum is kept.
///
/// Of a particle in periodic space the image nearest to the middle of the tool counts.
template <int dim> class WallContacts {
public:
  /// Finds the contacts of the start.
  /// @param skin  by which the list of particles near the tool reaches farther than they do, m
  /// @throws std::invalid_argument for a stiffness or a friction that cannot be
  WallContacts(const WallMaterial& material, const Tool<dim>& tool, const Particles<dim>& particles,
               double skin, const Period<dim>& period);

  /// Takes notice of a step in which no particle moved farther than this, m.
  void wear(double farthest) noexcept { worn_ += farthest; }

  /// Lists the particles near the tool again when it is time.
  /// @param time  that the tool has moved since the last call, s; 0 in the first step
  void begin_step(const Tool<dim>& tool, const Particles<dim>& particles, double time);
  /// Brings the contacts of a block to the current positions and adds what they do to the particles
  /// to loads.own.
  /// @param increment  of the particles
  /// @return what the particles of the block do to the tool, in space
  ToolLoad<dim> compute(std::size_t block, const Tool<dim>& tool, const Particles<dim>& particles,
                        const Increment<dim>& increment, double time, Loads<dim>& loads) {
    return compute_block(blocks_[block], {tool, particles, increment, time}, loads);
  }

  /// Makes the normal forces of all contacts those given, in the order of for_each(), by the gap
  /// at which they are free of stress; before the first step.
  void preload(std::span<const double> normal_force);

  const WallMaterial& material() const noexcept { return material_; }
  std::size_t size() const noexcept;
  /// Calls visit(contact, place) for all contacts, by particle.
  template <class Visit> void for_each(Visit visit) const {
    for (const Block& block : blocks_)
      for (std::size_t k = 0; k < block.now.size(); ++k)
        visit(block.now.contacts[k], block.now.places[k]);
  }

  double elastic_energy() const; // J
  double friction_loss() const;  // so far, J

private:
  friend struct StateParts;

  /// Contacts by particle; those of one particle stand together.
  struct List {
    std::vector<WallContact<dim>> contacts;
    std::vector<FacetContact<dim>> places;

    std::size_t size() const noexcept { return contacts.size(); }
    void clear() {
      contacts.clear();
      places.clear();
    }
  };
  /// The particles of a block (see particles_per_block) that are near the tool.
  struct Block {
    std::vector<std::uint32_t> particles;     // ascending
    std::vector<std::uint32_t> offset, facet; // facets near particle k: offset[k] to offset[k + 1]
    List now, before;                         // contacts of this step and of the last one
    double friction_loss = 0.0;               // J
    std::vector<FacetContact<dim>> found;     // scratch
    std::vector<std::uint32_t> from;          // scratch
  };
  /// What all particles have in common in one step.
  struct Step {
    const Tool<dim>& tool;
    const Particles<dim>& particles;
    const Increment<dim>& increment;
    double time; // s
  };
  struct Approach;

  void renew(const Tool<dim>& tool, const Particles<dim>& particles);
  Vec<dim> image(const Tool<dim>& tool, const Vec<dim>& position) const;
  void find_near(const Tool<dim>& tool, const Vec<dim>& position, double radius,
                 std::vector<std::uint32_t>& found) const;
  ToolLoad<dim> compute_block(Block& block, const Step& step, Loads<dim>& loads) const;
  void touch(Block& block, const ToolShape<dim>& shape, const Approach& approach, std::size_t first,
             std::size_t last) const;
  void continue_across_seam(Block& block, const Approach& approach, std::size_t first,
                            std::size_t last) const;
  void follow(WallContact<dim>& contact, const FacetContact<dim>& now,
              const FacetContact<dim>* before, const Approach& approach, double& loss) const;
  void end(const WallContact<dim>& contact, const FacetContact<dim>& before,
           const Approach& approach, double& loss) const;

  WallMaterial material_;
  Period<dim> period_;
  Vec<dim> middle_;     // of the tool, in its frame, m
  double extent_ = 0.0; // of the tool from its reference point; infinite for a plane, m
  double skin_ = 0.0;   // m
  double worn_ = 0.0;   // bound of how far a particle has moved past the tool since renew(), m
  double reach_ = 0.0;  // from the reference point to what may touch before the next renew(), m
  std::vector<Block> blocks_;
};

} // namespace kerf::dem
