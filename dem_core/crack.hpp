// A bond that broke: when, where, how, and what it released.
#pragma once

#include "dem_core/contact.hpp"
#include "dem_core/contact_forces.hpp"

#include <cstdint>

namespace kerf::dem {

template <int dim> struct Crack {
  std::uint64_t step = 0;
  double time = 0.0;                   // s
  std::uint32_t first = 0, second = 0; // particles of the bond
  Vec<dim> place = Vec<dim>::Zero();   // the point of contact, m
  Vec<dim> normal = Vec<dim>::Zero();  // from the first to the second
  BreakMode mode = BreakMode::tension; //
  double energy = 0.0;                 // released, with the weight of the contact, J
  double strength = 0.0;               // R_n or R_t that was exceeded, N
};

/// The crack that a break has made.
template <int dim>
Crack<dim> crack_of(const Break<dim>& lost, const Contacts<dim>& contacts, std::uint64_t step,
                    double time);

} // namespace kerf::dem
