// The keys of a body of elements beside its mesh and its motion: what it is made of.
#include "common/config/schema_rows.hpp"

namespace kerf::config {
namespace {

/// What every material may have.
std::vector<Key> common_keys(const std::string& key) {
  using enum Type;
  return {
      {key + ".model", "fem", text, "", R"("linear_elastic")",
       one_of({"linear_elastic", "transversely_isotropic", "neo_hookean", "j2_plastic",
               "drucker_prager", "isotropic_damage", "from_packing"}),
       R"("linear_elastic")", "the constitutive law; the user guide has the keys of each"},
      {key + ".density", "fem", number, "kg/m³", none, in(above_zero), "2358.0",
       "the bulk density; next to particles theirs with the pores", live},
      {key + ".participant", "fem", text, "", none, anything, R"("rock")",
       "the participant whose bonded particles have the stiffness and the bulk density; of "
       "from_packing"},
      {key + ".finite_strain", "fem", flag, "", none, anything, "true",
       "true for strain of the current configuration with an objective stress rate; small strain "
       "when not given; neo_hookean is always of finite strain"},
      {key + ".formulation", "fem", text, "", R"("full")",
       one_of({"full", "mean_dilatation", "one_point", "nodal_pressure"}), R"("full")",
       "how elements are integrated: quad4 and hex8 full, with mean_dilatation (B-bar) or "
       "one_point "
       "with hourglass control, tri3 and tet4 full or with nodal_pressure"},
      {key + ".hourglass_stiffness", "fem", number, "", none, in(from_zero), "0.1",
       "the stiffness of the hourglass control of one_point, as a share of about that of full "
       "integration; 0.1 when not given"},
      {key + ".hourglass_viscosity", "fem", number, "", none, in(share), "0.1",
       "the viscosity of the hourglass control of one_point: twice the damping ratio of a "
       "hourglass "
       "mode with the stiffness of full integration; 0 when not given"},
      {key + ".linear_viscosity", "fem", number, "", "0.0", in(from_zero), "0.06",
       "the linear coefficient of bulk viscosity, over density, wave speed and element length"},
      {key + ".quadratic_viscosity", "fem", number, "", "0.0", in(from_zero), "1.2",
       "the quadratic coefficient of bulk viscosity, which acts in compression only"},
  };
}

std::vector<Key> elastic_keys(const std::string& key) {
  using enum Type;
  const Range poisson{.least = -1.0, .most = 0.5, .without_least = true, .without_most = true};
  const Range around_zero{.least = -1.0, .most = 1.0, .without_least = true, .without_most = true};
  return {
      {key + ".young_modulus", "fem", number, "Pa", none, in(above_zero), "1.247e10",
       "Young's modulus of the solid, also in 2D", live},
      {key + ".poisson_ratio", "fem", number, "", none, in(poisson), "0.2",
       "Poisson's ratio of the solid, also in 2D", live},
      {key + ".C11", "fem", number, "Pa", none, in(above_zero), "1.3856e10",
       "instead of these two: the stiffness lambda + 2 mu of uniaxial strain"},
      {key + ".C12", "fem", number, "Pa", none, anything, "3.4641e9",
       "with C11: the stiffness lambda across uniaxial strain"},
      {key + ".young_in_plane", "fem", number, "Pa", none, in(above_zero), "4e10",
       "Young's modulus E_p along the layers; of transversely_isotropic"},
      {key + ".young_normal", "fem", number, "Pa", none, in(above_zero), "2e10",
       "Young's modulus E_n across the layers; of transversely_isotropic"},
      {key + ".poisson_in_plane", "fem", number, "", none, in(around_zero), "0.2",
       "Poisson's ratio in the layers; of transversely_isotropic"},
      {key + ".poisson_normal", "fem", number, "", none, anything, "0.15",
       "the contraction across over the extension along the layers, for stress along them; of "
       "transversely_isotropic"},
      {key + ".shear_normal", "fem", number, "Pa", none, in(above_zero), "1e10",
       "the shear modulus of planes across the layers; of transversely_isotropic"},
      {key + ".axis", "fem", numbers, "", none, anything, "[0.0, 1.0, 0.0]",
       "x y z of the normal of the layers, of any length, of transversely_isotropic; z when not "
       "given"},
  };
}

std::vector<Key> strength_keys(const std::string& key) {
  using enum Type;
  const Range angle{.least = 0.0, .most = 90.0, .without_most = true};
  return {
      {key + ".yield_stress", "fem", number, "Pa", none, in(above_zero), "4e8",
       "the uniaxial stress at which flow begins; of j2_plastic"},
      {key + ".hardening_modulus", "fem", number, "Pa", none, in(from_zero), "1e8",
       "the rise of the yield stress with plastic strain, of j2_plastic; 0 when not given"},
      {key + ".saturation_stress", "fem", number, "Pa", none, in(from_zero), "1e8",
       "Q of the hardening Q (1 - exp(-b p)) of Voce; of j2_plastic"},
      {key + ".saturation_exponent", "fem", number, "", none, in(above_zero), "10.0",
       "b of the hardening of Voce; of j2_plastic"},
      {key + ".hardening_table", "fem", curve, "1, Pa", none, anything, "[[0.0, 4e8], [0.1, 5e8]]",
       "rows of plastic strain, from 0, and yield stress, instead of yield_stress; of j2_plastic"},
      {key + ".reference_rate", "fem", number, "1/s", none, in(above_zero), "40.0",
       "D of the factor 1 + (rate / D)^(1/q) of Cowper and Symonds; of j2_plastic"},
      {key + ".rate_exponent", "fem", number, "", none, in(from_one), "5.0",
       "q of Cowper and Symonds; of j2_plastic"},
      {key + ".cohesion", "fem", number, "Pa", none, in(from_zero), "5e6",
       "the cohesion of Mohr and Coulomb; of drucker_prager"},
      {key + ".friction_angle", "fem", number, "°", none, in(angle), "40.0",
       "the angle of friction; of drucker_prager"},
      {key + ".dilation_angle", "fem", number, "°", none, in(angle), "10.0",
       "the angle of dilation, up to that of friction, of drucker_prager; 0 when not given"},
      {key + ".fit", "fem", text, "", none, one_of({"outer", "inner", "plane_strain"}),
       R"("outer")",
       "what the cone has in common with Mohr and Coulomb: triaxial compression, triaxial "
       "extension or the limit load in plane strain, of drucker_prager; outer when not given"},
      {key + ".tension_cutoff", "fem", number, "Pa", none, in(from_zero), "2e6",
       "the largest mean stress, of drucker_prager; the apex of the cone when not given"},
      {key + ".tensile_strength", "fem", number, "Pa", none, in(above_zero), "1e7",
       "the uniaxial stress at which damage begins; of isotropic_damage"},
      {key + ".strength_ratio", "fem", number, "", none, in(from_one), "10.0",
       "compressive over tensile strength, of isotropic_damage; 10 when not given"},
      {key + ".fracture_energy", "fem", number, "J/m²", none, in(above_zero), "100.0",
       "the energy that a crack takes for its area; of isotropic_damage"},
  };
}

} // namespace

std::vector<Key> solid_keys() {
  using enum Type;
  const std::string own = "participants.*.material", other = "participants.*.materials[]";
  std::vector<Key> keys = {
      {"participants.*.plane", "fem", text, "", none, one_of({"strain", "stress", "axisymmetric"}),
       R"("strain")",
       "what 2D means: plane strain, plane stress, or a body of revolution about y with x as the "
       "radius; strain when not given"},
      {"participants.*.gravity", "fem", vector, "m/s²", none, anything, "[0.0, -9.81]",
       "the acceleration of gravity"},
      {"participants.*.damping", "fem", table, "", tables, anything, "damping",
       "numerical damping"},
      {"participants.*.damping.mass", "fem", number, "1/s", "0.0", in(from_zero), "100.0",
       "a of the force -a m v on every node: damping as of Rayleigh, by mass"},
      {"participants.*.damping.local", "fem", number, "", "0.0", in(share), "0.2",
       "the share of the resultant force that opposes the motion"},
      {"participants.*.damping.kinetic", "fem", flag, "", "false", anything, "true",
       "stops the body whenever its kinetic energy has passed a peak: a quick way to rest"},
      {own, "fem", optional_table, "", none, anything, "material",
       "the solid of all elements without one of the further materials", live},
      {"participants.*.materials", "fem", list, "", empty, anything, "further material",
       "the solid of some of the elements; of two for one element the later counts"},
      {other + ".region", "fem", text, "", none, anything, R"("rock")",
       "the tag of its elements in the mesh", live},
      {other + ".box", "fem", box, "m", none, anything, "[[0.0, 0.0], [1e-2, 1e-2]]",
       "the lower and upper corner around the centres of its elements; with a region, of those in "
       "it"},
  };
  for (const std::string& key : {own, other})
    for (const auto& part : {common_keys(key), elastic_keys(key), strength_keys(key)})
      keys.insert(keys.end(), part.begin(), part.end());
  return keys;
}

} // namespace kerf::config
