// The keys of the materials of particles, and of pairs of them.
#include "common/config/schema_rows.hpp"

namespace kerf::config {
namespace {

/// What counts for contacts; a pair has them without defaults.
std::vector<Key> contact_keys(const std::string& key, bool has_defaults) {
  using enum Type;
  const auto standard = [&](const char* value) { return has_defaults ? value : none; };
  return {
      {key + ".law", "dem", text, "", standard(R"("linear")"),
       one_of({"linear", "linear_by_size", "hertz_mindlin"}), R"("linear")",
       "the contacts: springs of one stiffness, springs from a modulus and the radii, or spheres "
       "of Hertz and Mindlin, whose bonds are springs"},
      {key + ".normal_stiffness", "dem", number, "N/m", none, in(above_zero), "1e10",
       "the normal stiffness of law = \"linear\" and of bonds; in 2D per metre of thickness",
       has_defaults},
      {key + ".tangential_stiffness", "dem", number, "N/m", none, in(from_zero), "2e9",
       "the tangential stiffness of law = \"linear\" and of bonds; in 2D per metre of thickness",
       has_defaults},
      {key + ".contact_modulus", "dem", number, "Pa", none, in(above_zero), "2e10",
       "E_c of law = \"linear_by_size\": normal stiffness 4 E_c r_i r_j / (r_i + r_j), in 2D E_c"},
      {key + ".stiffness_ratio", "dem", number, "", none, in(from_zero), "0.3",
       "tangential over normal stiffness of law = \"linear_by_size\""},
      {key + ".young_modulus", "dem", number, "Pa", none, in(above_zero), "7e10",
       "Young's modulus of the particles of law = \"hertz_mindlin\""},
      {key + ".poisson_ratio", "dem", number, "", none,
       in({.least = -1.0, .most = 0.5, .without_least = true}), "0.23",
       "Poisson's ratio of the particles of law = \"hertz_mindlin\""},
      {key + ".friction", "dem", number, "", standard("0.0"), in(from_zero), "0.839",
       "the Coulomb friction coefficient of contacts without a bond"},
      {key + ".rolling_friction", "dem", number, "", standard("0.0"), in(from_zero), "0.1",
       "mu_r: contacts without a bond resist rolling with up to mu_r r_i r_j / (r_i + r_j) |F_n|"},
      {key + ".restitution", "dem", number, "", standard("1.0"),
       in({.least = 0.0, .most = 1.0, .without_least = true}), "0.9",
       "the coefficient of restitution that dashpots give a collision; 1 for no dashpots"},
      {key + ".tensile_strength", "dem", number, "N", none, in(from_zero), "2.9e4",
       "the normal force that breaks a bond, in 2D per metre; unbreakable when not given"},
      {key + ".shear_strength", "dem", number, "N", none, in(from_zero), "2.9e4",
       "the tangential force that breaks a bond, in 2D per metre; unbreakable when not given"},
      {key + ".tensile_stress", "dem", number, "Pa", none, in(from_zero), "1e7",
       "the tensile strength over the cross-section of a bond"},
      {key + ".shear_stress", "dem", number, "Pa", none, in(from_zero), "1e7",
       "the shear strength over the cross-section of a bond"},
      {key + ".bond_radius_ratio", "dem", number, "", standard("0.0"), in(from_zero), "1.0",
       "the radius of the bond's cross-section over the smaller particle's: bonds bend and twist; "
       "0 for bonds without moments"},
  };
}

Key density_key(const std::string& key) {
  return {key + ".density", "dem",          Type::number, "kg/m³",
          required,         in(above_zero), "2600.0",     "the density of the solid particles"};
}

} // namespace

std::vector<Key> material_keys() {
  using enum Type;
  const std::string own = "participants.*.material", other = "participants.*.materials[]",
                    pairs = "participants.*.pairs[]";
  std::vector<Key> keys = {
      {own, "dem", table, "", tables, anything, "material", "the particles and their contacts"},
      density_key(own)};
  const auto add = [&](const std::vector<Key>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
  };
  add(contact_keys(own, true));
  add({{own + ".name", "dem", name, "", R"("default")", anything, R"("default")",
        "what pairs call it"},
       {"participants.*.materials", "dem", list, "", empty, anything, "further material",
        "another material of some of the particles; of two for one particle the later counts"},
       {other + ".name", "dem", name, "", required, anything, R"("grains")", "a name, used once"},
       {other + ".box", "dem", box, "m", none, anything, "[[0.0, 0.0], [1e-3, 1e-3]]",
        "the lower and upper corner around its particles, before they move", live},
       {other + ".ids", "dem", numbers, "", none, anything, "[0, 1, 2]",
        "instead of box: its particles"},
       {other + ".file", "dem", path, "", none, anything, R"("phases.txt")",
        "instead of box: a file with a line for each particle, a whole number in its last column"},
       {other + ".number", "dem", integer, "", none, in(from_zero), "1",
        "the number that its particles have in the file"},
       density_key(other)});
  add(contact_keys(other, true));
  add({{"participants.*.pairs", "dem", list, "", empty, anything, "pair of materials",
        "what counts for contacts between two materials; what is not given is mixed"},
       {pairs + ".between", "dem", pair, "", required, anything, R"(["default", "grains"])",
        "the names of the two; twice the same for contacts within a material"},
       {pairs + ".bonds", "dem", flag, "", none, anything, "true",
        "whether bonds.kind is also for them; true when not given"}});
  add(contact_keys(pairs, false));
  return keys;
}

} // namespace kerf::config
