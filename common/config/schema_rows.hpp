// How the rows of the table of keys are written.
#pragma once

#include "common/config/schema.hpp"

#include <string>
#include <vector>

namespace kerf::config {

inline const Range above_zero{.least = 0.0, .without_least = true};
inline const Range from_zero{.least = 0.0};
inline const Range from_one{.least = 1.0};
inline const Range share{.least = 0.0, .most = 1.0};

inline const Allowed anything;
inline Allowed one_of(std::vector<std::string> choices) {
  return {.range = {}, .choices = std::move(choices)};
}
inline Allowed in(Range range) {
  return {.range = range, .choices = {}};
}

// Defaults that are not values.
inline const std::string required;      // the user must give it
inline const std::string none = "null"; // nothing, unless given
inline const std::string empty = "[]";  // no members, unless given
inline const std::string tables = "{}"; // its keys have defaults of their own

inline constexpr bool live = true; // see Key::live

/// The keys of "participants.*" of one kind.
std::vector<Key> particle_keys();
std::vector<Key> mesh_keys();
/// Those of its elements.
std::vector<Key> element_keys();
/// Those of what they are made of.
std::vector<Key> solid_keys();
/// Those of what acts on them beside prescribed motions, and of their probes.
std::vector<Key> action_keys();
/// Those of its materials; of particles only.
std::vector<Key> material_keys();
/// Those of its rigid tools; of particles only.
std::vector<Key> tool_keys();

/// The keys of a list of stop conditions.
std::vector<Key> stop_keys(const std::string& key);
/// The keys of stages, some of which are keys of particles or elements again.
std::vector<Key> stage_keys(const std::vector<Key>& particles, const std::vector<Key>& elements);
/// Those of its rigid clusters.
std::vector<Key> cluster_keys();

/// The keys of "participants.*.particles.packing", which is made before the run.
std::vector<Key> packing_keys();

} // namespace kerf::config
