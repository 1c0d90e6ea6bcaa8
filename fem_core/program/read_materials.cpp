#include "fem_core/program/read_materials.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/program/read_boundary.hpp"

#include <functional>
#include <numbers>

namespace kerf::fem {

using coupler::SettingsError;

namespace {

/// @param dimension  of the strains that the solid must withstand
IsotropicElastic read_elastic(const Table& table, int dimension) {
  const bool moduli = table.has("C11") || table.has("C12");
  if (moduli == (table.has("young_modulus") || table.has("poisson_ratio")))
    throw SettingsError(table.path(), "give exactly one pair: young_modulus and poisson_ratio, or "
                                      "C11 and C12");
  if (moduli)
    return IsotropicElastic::from_moduli(table.number("density"), table.number("C11"),
                                         table.number("C12"), dimension);
  return IsotropicElastic::from_young(table.number("density"), table.number("young_modulus"),
                                      table.number("poisson_ratio"));
}

TransverselyIsotropic read_layered(const Table& table, int dimension) {
  TransverselyIsotropic::Parameters p{.density = table.number("density"),
                                      .young_in_plane = table.number("young_in_plane"),
                                      .young_normal = table.number("young_normal"),
                                      .poisson_in_plane = table.number("poisson_in_plane"),
                                      .poisson_normal = table.number("poisson_normal"),
                                      .shear_normal = table.number("shear_normal")};
  if (table.has("axis")) {
    const std::vector<double> axis = table.numbers("axis", 3);
    p.axis = {axis[0], axis[1], axis[2]};
  }
  return TransverselyIsotropic::from(p, dimension);
}

Hardening read_hardening(const Table& table) {
  if (table.has("hardening_table")) {
    const auto [strain, stress] = table.columns("hardening_table");
    return Hardening::table(strain, stress);
  }
  const double yield_stress = table.number("yield_stress");
  const double modulus = table.number("hardening_modulus", 0.0);
  if (!table.has("saturation_stress"))
    return Hardening::linear(yield_stress, modulus);
  return Hardening::voce(yield_stress, table.number("saturation_stress"),
                         table.number("saturation_exponent"), modulus);
}

J2Plastic read_j2_plastic(const Table& table) {
  const RateDependence rate = table.has("reference_rate")
                                  ? RateDependence::cowper_symonds(table.number("reference_rate"),
                                                                   table.number("rate_exponent"))
                                  : RateDependence{};
  return J2Plastic::from(read_elastic(table, 3), read_hardening(table), rate);
}

DruckerPrager read_drucker_prager(const Table& table) {
  using enum DruckerPrager::Fit;
  constexpr double degree = std::numbers::pi / 180.0;
  return DruckerPrager::from(
      read_elastic(table, 3),
      {.cohesion = table.number("cohesion"),
       .friction_angle = table.number("friction_angle") * degree,
       .dilation_angle = table.number("dilation_angle", 0.0) * degree,
       .fit = table.one_of<DruckerPrager::Fit>(
           "fit", outer, {{"outer", outer}, {"inner", inner}, {"plane_strain", plane_strain}}),
       .tension_cutoff = table.number("tension_cutoff", -1.0)});
}

IsotropicDamage read_damage(const Table& table) {
  IsotropicDamage::Parameters p{.tensile_strength = table.number("tensile_strength"),
                                .fracture_energy = table.number("fracture_energy")};
  p.strength_ratio = table.number("strength_ratio", p.strength_ratio);
  return IsotropicDamage::from(read_elastic(table, 3), p);
}

Law read_law(const Table& table, int dimension, Plane plane) {
  const auto elastic = [&] { return read_elastic(table, plane == Plane::strain ? dimension : 3); };
  return table.one_of<std::function<Law()>>(
      "model", elastic,
      {{"linear_elastic", elastic},
       {"transversely_isotropic", [&] { return read_layered(table, dimension); }},
       {"neo_hookean", [&] { return NeoHookean::from(read_elastic(table, 3)); }},
       {"j2_plastic", [&] { return read_j2_plastic(table); }},
       {"drucker_prager", [&] { return read_drucker_prager(table); }},
       {"isotropic_damage", [&] { return read_damage(table); }}})();
}

Material read_material(const Table& table, int dimension, Plane plane) {
  using enum Formulation;
  Material material;
  try {
    material.law = read_law(table, dimension, plane);
  } catch (const InputError& error) { // with the key "material.density"
    throw SettingsError(table.path(error.key().substr(error.key().find('.') + 1)), error.what());
  }
  material.finite_strain = table.flag("finite_strain", false);
  material.formulation = table.one_of<Formulation>("formulation", full,
                                                   {{"full", full},
                                                    {"mean_dilatation", mean_dilatation},
                                                    {"one_point", one_point},
                                                    {"nodal_pressure", nodal_pressure}});
  material.hourglass_stiffness = table.number("hourglass_stiffness", material.hourglass_stiffness);
  material.hourglass_viscosity = table.number("hourglass_viscosity", 0.0);
  material.linear_viscosity = table.number("linear_viscosity", 0.0);
  material.quadratic_viscosity = table.number("quadratic_viscosity", 0.0);
  return material;
}

} // namespace

Plane read_plane(const Table& participant) {
  return participant.one_of<Plane>("plane", Plane::strain,
                                   {{"strain", Plane::strain},
                                    {"stress", Plane::stress},
                                    {"axisymmetric", Plane::axisymmetric}});
}

template <int dim>
std::vector<MaterialSetting<dim>> read_materials(const Table& participant, const Mesh<dim>& mesh) {
  const Plane plane = read_plane(participant);
  std::vector<MaterialSetting<dim>> materials;
  if (participant.has("material"))
    materials.push_back({.material = read_material(participant.table("material"), dim, plane)});
  for (const Table& table : participant.list("materials")) {
    MaterialSetting<dim>& setting =
        materials.emplace_back(MaterialSetting<dim>{.material = read_material(table, dim, plane)});
    if (table.has("region")) {
      setting.region = table.text("region");
      check_region(mesh, setting.region, table.path("region"));
    }
    if (table.has("box")) {
      const auto [lower, upper] = table.corners<dim>("box");
      setting.box = Box<dim>{lower, upper};
    }
  }
  if (materials.empty())
    throw SettingsError("material", "it is missing; give a table");
  return materials;
}

std::string case_key(const Table& participant, const std::string& key) {
  const std::string list = "materials[";
  if (!participant.has("material") || !key.starts_with(list))
    return key;
  std::size_t digits = 0;
  const int number = std::stoi(key.substr(list.size()), &digits);
  const std::string rest = key.substr(list.size() + digits + 1); // behind the bracket
  return number == 0 ? "material" + rest : fmt::format("materials[{}]{}", number - 1, rest);
}

template std::vector<MaterialSetting<2>> read_materials<2>(const Table&, const Mesh<2>&);
template std::vector<MaterialSetting<3>> read_materials<3>(const Table&, const Mesh<3>&);

} // namespace kerf::fem
