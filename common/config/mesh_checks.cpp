// What can be wrong with a mesh beyond the types of its values.
#include "common/config/case_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

struct MeshKind {
  string type;
  std::vector<int> dimensions;
  std::vector<string> needed, optional;
};

/// The kinds that a case can ask for, with the keys that they read in its dimension.
std::vector<MeshKind> kinds(int dimension) {
  std::vector<string> of_ring = {"center", "inner_radius", "radius", "count"};
  if (dimension == 3)
    of_ring.push_back("length");
  return {{"box", {2, 3}, {"origin", "size", "count"}, {"shape", "grading"}},
          {"bar", {2, 3}, {"origin", "size", "elements"}, {"shape"}},
          {"disc", {2}, {"center", "radius", "count"}, {"shape"}},
          {"cylinder", {3}, {"center", "radius", "length", "count"}, {"shape"}},
          {"ring", {2, 3}, of_ring, {"shape", "radial_grading"}},
          {"tunnel",
           {2, 3},
           {"origin", "size", "radius", "count"},
           {"shape", "center", "radial_grading", "excavation"}},
          {"file", {2, 3}, {"file"}, {"scale", "element_size"}}};
}

bool has(const std::vector<string>& names, const string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

void check_mesh(const string& key, const json& mesh, const json& case_settings,
                Problems& problems) {
  const int dimension = case_settings["dimension"];
  const std::vector<MeshKind> all = kinds(dimension);
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const MeshKind& kind) { return kind.type == mesh["type"]; });
  const MeshKind& own = *found;
  if (std::find(own.dimensions.begin(), own.dimensions.end(), dimension) == own.dimensions.end())
    return problems.add(
        key + ".type",
        fmt::format("{}.type = \"{}\" is not of case.dimension = {}.", key, own.type, dimension),
        own.type == "disc" ? "give cylinder, or ring." : "give disc, or ring.");

  for (const string& name : own.needed)
    if (mesh[name].is_null())
      problems.add(key + "." + name, fmt::format("{}.{} is missing.", key, name),
                   fmt::format("type = \"{}\" needs {}.", own.type, fmt::join(own.needed, ", ")));
  for (const auto& [name, value] : mesh.items()) {
    if (value.is_null() || name == "type" || has(own.needed, name) || has(own.optional, name))
      continue;
    std::vector<string> users;
    for (const MeshKind& kind : all)
      if (has(kind.needed, name) || has(kind.optional, name))
        users.push_back(kind.type);
    problems.add(
        key + "." + name,
        fmt::format("{}.{} is given, but type = \"{}\" does not use it.", key, name, own.type),
        fmt::format("leave it out; {}.",
                    users.empty() ? "it is for other dimensions"
                                  : fmt::format("it is for {}", fmt::join(users, ", "))));
  }

  const json& shape = mesh["shape"];
  if (!shape.is_null() && (dimension == 2) != (shape == "tri3" || shape == "quad4"))
    problems.add(
        key + ".shape",
        fmt::format("{}.shape = {} is not of case.dimension = {}.", key, shape.dump(), dimension),
        dimension == 2 ? "give quad4 or tri3." : "give hex8 or tet4.");
  const bool can_repeat = own.type == "box" || own.type == "bar";
  for (const auto& [axis, ends] : case_settings["periodic"].items())
    if (!can_repeat && !ends.is_null())
      problems.add(key + ".type",
                   fmt::format("{}.type = \"{}\" cannot repeat itself along the periodic axis {}.",
                               key, own.type, axis),
                   fmt::format("give a box, or leave out case.periodic.{}.", axis));
}

} // namespace kerf::config
