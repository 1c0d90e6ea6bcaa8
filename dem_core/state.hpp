// What of each part of the engine is its state: everything that steps change. The rest comes from
// the settings. Every part names all of its members, so that a new one does not compile unlisted.
#pragma once

#include "common/state.hpp"
#include "dem_core/applied_forces.hpp"
#include "dem_core/boundary.hpp"
#include "dem_core/clusters.hpp"
#include "dem_core/contact.hpp"
#include "dem_core/crack.hpp"
#include "dem_core/energy.hpp"
#include "dem_core/reactions.hpp"
#include "dem_core/tool.hpp"
#include "dem_core/wall_contacts.hpp"

namespace kerf {

template <int dim, class Visit> void visit_parts(FacetContact<dim>& contact, Visit& visit) {
  auto& [feature, point, normal, gap, facet, weight] = contact;
  visit("feature", feature.kind);
  visit("index", feature.index);
  visit("point", point);
  visit("normal", normal);
  visit("gap", gap);
  visit("facet", facet);
  visit("weight", weight);
}

} // namespace kerf

namespace kerf::dem {

/// A friend of every part.
struct StateParts {
  template <int dim, class Visit> static void of(Particles<dim>& particles, Visit& visit) {
    auto& [reference, radius, density, material, ids, cluster, weight, mass, true_mass, inertia,
           displacement, velocity, angular_velocity] = particles;
    visit("displacement", displacement);
    visit("velocity", velocity);
    visit("angular_velocity", angular_velocity);
  }

  template <int dim, class Visit> static void of(PrescribedMotion<dim>& motion, Visit& visit) {
    auto& [components, velocity, angular_velocity, velocity_before, angular_velocity_before] =
        motion;
    visit("components", components);
    visit("velocity", velocity);
    visit("angular_velocity", angular_velocity);
    visit("velocity_before", velocity_before);
    visit("angular_velocity_before", angular_velocity_before);
  }
  template <int dim, class Visit> static void of(Boundary<dim>& boundary, Visit& visit) {
    auto& [prescriptions, begin, sets, motion, entry] = boundary;
    visit("begin", begin);
    visit("motion", motion);
  }

  template <int size, class Visit> static void of(Columns<size>& columns, Visit& visit) {
    visit("axis", columns.of);
  }
  template <class Visit> static void of(PerContact& constant, Visit& visit) {
    double all = constant.all();
    std::vector<double> each(constant.each().begin(), constant.each().end());
    visit("all", all);
    visit("each", each);
    constant.set_all(all);
    constant.set_each(std::move(each));
  }
  template <class Visit> static void of(ContactLosses& losses, Visit& visit) {
    auto& [friction, fracture, viscous] = losses;
    visit("friction", friction);
    visit("fracture", fracture);
    visit("viscous", viscous);
  }
  /// With what could be found again from the pairs: it is little, and order is everything.
  template <int dim, class Visit> static void of(Contacts<dim>& contacts, Visit& visit) {
    auto& [first, second, reference_branch, rest_length, share, bonded, normal_force, shear_force,
           normal_stiffness, tangential_stiffness, tensile_strength, shear_strength, friction,
           weight, law, has_moments, normal_viscosity, tangential_viscosity, bending_stiffness,
           twisting_stiffness, bond_lever, rolling_limit, moment, block_offset, loose_offset,
           hertz_offset, target, waiting_offset, incoming_offset, incoming_row, incoming_second,
           losses, clear_until] = contacts;
    visit("first", first);
    visit("second", second);
    visit("reference_branch", reference_branch);
    visit("rest_length", rest_length);
    visit("share", share);
    visit("bonded", bonded);
    visit("normal_force", normal_force);
    visit("shear_force", shear_force);
    visit("normal_stiffness", normal_stiffness);
    visit("tangential_stiffness", tangential_stiffness);
    visit("tensile_strength", tensile_strength);
    visit("shear_strength", shear_strength);
    visit("friction", friction);
    visit("weight", weight);
    visit("law", law);
    visit("has_moments", has_moments);
    visit("normal_viscosity", normal_viscosity);
    visit("tangential_viscosity", tangential_viscosity);
    visit("bending_stiffness", bending_stiffness);
    visit("twisting_stiffness", twisting_stiffness);
    visit("bond_lever", bond_lever);
    visit("rolling_limit", rolling_limit);
    visit("moment", moment);
    visit("block_offset", block_offset);
    visit("loose_offset", loose_offset);
    visit("hertz_offset", hertz_offset);
    visit("target", target);
    visit("waiting_offset", waiting_offset);
    visit("incoming_offset", incoming_offset);
    visit("incoming_row", incoming_row);
    visit("incoming_second", incoming_second);
    visit("losses", losses);
  }
  template <int dim, class Visit> static void of(Skin<dim>& skin, Visit& visit) {
    auto& [width, bound, displacement] = skin;
    visit("bound", bound);
    visit("displacement", displacement);
  }

  template <int dim, class Visit> static void of(Pose<dim>& pose, Visit& visit) {
    auto& [start, reference, rotation] = pose;
    visit("reference", reference);
    visit("rotation", rotation);
  }
  template <int dim, class Visit> static void of(RigidVelocity<dim>& velocity, Visit& visit) {
    auto& [translation, rotation] = velocity;
    visit("translation", translation);
    visit("rotation", rotation);
  }
  template <int dim, class Visit> static void of(ToolMover<dim>& mover, Visit& visit) {
    auto& [motion, begin, translation_before, angle_before, servo_way, free_translation,
           free_velocity, free_angle, free_rate] = mover;
    visit("begin", begin);
    visit("translation_before", translation_before);
    visit("angle_before", angle_before);
    visit("servo_way", servo_way);
    visit("free_translation", free_translation);
    visit("free_velocity", free_velocity);
    visit("free_angle", free_angle);
    visit("free_rate", free_rate);
  }
  /// The load begins anew in every step.
  template <int dim, class Visit> static void of(Tool<dim>& tool, Visit& visit) {
    auto& [shape, mover, step, time_step, pose, pose_before, angle, velocity, load, power, work,
           work_ahead] = tool;
    visit("motion", mover);
    visit("step", step);
    visit("time_step", time_step);
    visit("pose", pose);
    visit("pose_before", pose_before);
    visit("angle", angle);
    visit("velocity", velocity);
    visit("power", power);
    visit("work", work);
    visit("work_ahead", work_ahead);
  }

  template <int dim, class Visit> static void of(WallContact<dim>& contact, Visit& visit) {
    auto& [particle, rest_gap, arm, normal_force, shear_force] = contact;
    visit("particle", particle);
    visit("rest_gap", rest_gap);
    visit("arm", arm);
    visit("normal_force", normal_force);
    visit("shear_force", shear_force);
  }
  /// A block of WallContacts; what it holds of the step before is old between two steps.
  template <class Block, class Visit>
  requires requires(Block& block) { block.friction_loss; }
  static void of(Block& block, Visit& visit) {
    auto& [particles, offset, facet, now, before, friction_loss, found, from] = block;
    visit("particles", particles);
    visit("offset", offset);
    visit("facet", facet);
    visit("contacts", now.contacts);
    visit("places", now.places);
    visit("friction_loss", friction_loss);
  }
  template <int dim, class Visit> static void of(WallContacts<dim>& contacts, Visit& visit) {
    auto& [material, period, middle, extent, skin, worn, reach, blocks] = contacts;
    visit("worn", worn);
    visit("reach", reach);
    visit("blocks", blocks);
  }

  template <int dim, class Visit> static void of(Crack<dim>& crack, Visit& visit) {
    auto& [step, time, first, second, place, normal, mode, energy, strength] = crack;
    visit("step", step);
    visit("time", time);
    visit("first", first);
    visit("second", second);
    visit("place", place);
    visit("normal", normal);
    visit("mode", mode);
    visit("energy", energy);
    visit("strength", strength);
  }
  template <class Visit> static void of(Work& work, Visit& visit) {
    auto& [interface, damping] = work;
    visit("interface", interface);
    visit("damping", damping);
  }

  template <class Visit> static void of(RunningWork& running, Visit& visit) {
    auto& [power, work, ahead] = running;
    visit("power", power);
    visit("work", work);
    visit("ahead", ahead);
  }
  template <int dim, class Visit> static void of(Reactions<dim>& reactions, Visit& visit) {
    auto& [work, of_former_sets] = reactions;
    visit("sets", work);
    visit("of_former_sets", of_former_sets);
  }
  template <int dim, class Visit> static void of(AppliedForces<dim>& forces, Visit& visit) {
    auto& [settings, selected, work, now] = forces;
    visit("sets", work);
  }

  template <class Visit> static void of(Orientation<2>& orientation, Visit& visit) {
    auto& [angle] = orientation;
    visit("angle", angle);
  }
  template <class Visit> static void of(Orientation<3>& orientation, Visit& visit) {
    auto& [cosine, axis] = orientation;
    visit("cosine", cosine);
    visit("axis", axis);
  }
  template <int dim, class Visit> static void of(ClusterLoad<dim>& load, Visit& visit) {
    auto& [force, moment] = load;
    visit("force", force);
    visit("moment", moment);
  }
  template <int dim, class Visit> static void of(Cluster<dim>& cluster, Visit& visit) {
    auto& [members, arms, is_free, start, mass, weighed_mass, inertia, extent, least_inertia,
           initial, mover, reference, displacement, orientation, velocity, angular_momentum, rate,
           load, damping, velocity_before, rate_before, rate_after, displacement_before,
           orientation_before, load_work, damping_work, drive_work] = cluster;
    if (mover)
      visit("mover", *mover);
    visit("displacement", displacement);
    visit("orientation", orientation);
    visit("velocity", velocity);
    visit("angular_momentum", angular_momentum);
    visit("rate", rate);
    visit("load", load);
    visit("damping", damping);
    visit("velocity_before", velocity_before);
    visit("rate_before", rate_before);
    visit("rate_after", rate_after);
    visit("displacement_before", displacement_before);
    visit("orientation_before", orientation_before);
    visit("load_work", load_work);
    visit("damping_work", damping_work);
    visit("drive_work", drive_work);
  }
  template <int dim, class Visit> static void of(Clusters<dim>& clusters, Visit& visit) {
    auto& [all] = clusters;
    visit("body", all);
  }

  /// The engine itself; loads are computed anew in every step.
  template <class Whole, class Visit>
  requires requires(Whole& whole) { whole.unbalanced_force(); }
  static void of(Whole& whole, Visit& visit) {
    auto& [materials, damping, shear_increment, initial, period, particles, boundary, clusters,
           reactions, applied_forces, contacts, skin, tool_names, tools, wall_contacts,
           in_situ_stress, mass_scaling, gravity, weight_work_at_start, start_rotation,
           bonds_at_start, renewals, travelled, time_step, step, forces_are_current, loads, touched,
           is_touched, interface_forces_are_old, cracks, work, work_ahead] = whole;
    visit("time_step", time_step);
    visit("step", step);
    visit("particles", particles);
    visit("boundary", boundary);
    visit("reactions", reactions);
    visit("applied_forces", applied_forces);
    visit("clusters", clusters);
    visit("contacts", contacts);
    visit("skin", skin);
    visit("tools", tools);
    visit("wall_contacts", wall_contacts);
    visit("weight_work_at_start", weight_work_at_start);
    visit("bonds_at_start", bonds_at_start);
    visit("renewals", renewals);
    visit("cracks", cracks);
    visit("work", work);
    visit("work_ahead", work_ahead);
  }
};

template <class Part, class Visit> void visit_parts(Part& part, Visit& visit) {
  StateParts::of(part, visit);
}

} // namespace kerf::dem
