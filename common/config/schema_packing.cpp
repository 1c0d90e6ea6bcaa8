// The keys of a random packing.
#include "common/config/schema_rows.hpp"

#include <algorithm>

namespace kerf::config {
namespace {

/// Part of space: exactly one of a box, a ball, a cylinder and a surface.
std::vector<Key> region_keys(const std::string& prefix) {
  using enum Type;
  return {
      {prefix + ".box", "dem", box, "m", none, anything, "[[0.0, 0.0], [0.05, 0.05]]",
       "the lower and upper corner of a box"},
      {prefix + ".center", "dem", vector, "m", none, anything, "[0.0, 0.0]",
       "the center of a disc (2D) or a sphere (3D) with the given radius"},
      {prefix + ".bottom", "dem", vector, "m", none, anything, "[0.0, 0.0, 0.0]",
       "the center of one end of a cylinder with the given radius; 3D only"},
      {prefix + ".top", "dem", vector, "m", none, anything, "[0.0, 0.0, 0.1]",
       "the center of the other end"},
      {prefix + ".radius", "dem", number, "m", none, in(above_zero), "0.025",
       "the radius of a disc, sphere or cylinder"},
      {prefix + ".surface", "dem", path, "", none, anything, R"("sample.stl")",
       "a closed surface: STL in 3D; in 2D a text file with the corners of a polygon"},
  };
}

} // namespace

std::vector<Key> packing_keys() {
  using enum Type;
  const std::string packing = "participants.*.particles.packing";
  std::vector<Key> keys = {
      {packing, "dem", optional_table, "", none, anything, "packing",
       "a random dense packing, made before the run"},
      {packing + ".region", "dem", table, "", tables, anything, "region", "what the packing fills"},
      {packing + ".radii", "dem", table, "", tables, anything, "set of radii",
       "the distribution of the radii"},
      {packing + ".radii.law", "dem", text, "", R"("uniform")",
       one_of({"uniform", "power", "list"}), R"("power")",
       "the law: uniform or density ~ r^-exponent from min to max, or a list of values"},
      {packing + ".radii.min", "dem", number, "m", none, in(above_zero), "0.262e-3",
       "the smallest radius of law = \"uniform\" or \"power\""},
      {packing + ".radii.max", "dem", number, "m", none, in(above_zero), "0.653e-3",
       "the largest radius"},
      {packing + ".radii.exponent", "dem", number, "", none, anything, "3.56",
       "the exponent of law = \"power\""},
      {packing + ".radii.values", "dem", numbers, "m", none, in(above_zero), "[1e-3, 2e-3]",
       "the radii of law = \"list\""},
      {packing + ".radii.weights", "dem", numbers, "", none, in(from_zero), "[3.0, 1.0]",
       "how many particles each of the values has, up to a factor; all the same when not given"},
      {packing + ".porosity", "dem", number, "", required,
       in({.least = 0.0, .most = 1.0, .without_least = true, .without_most = true}), "0.13",
       "the share of the region outside of particles"},
      {packing + ".count", "dem", integer, "", none, in(from_one), "5000",
       "the number of particles, to which the radii are scaled; follows from them when not given"},
      {packing + ".seed", "dem", integer, "", none, in(from_zero), "1",
       "the seed of this packing; case.seed when not given"},
      {packing + ".cut", "dem", optional_table, "", none, anything, "region",
       "a part of the region whose particles are kept, by their centres"},
  };
  const auto add = [&](const std::string& table) {
    const auto after =
        std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.path == table; });
    const std::vector<Key> own = region_keys(table);
    keys.insert(after + 1, own.begin(), own.end());
  };
  add(packing + ".region");
  add(packing + ".cut");
  return keys;
}

} // namespace kerf::config
