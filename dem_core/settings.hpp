// What a particle model is made of: bodies, material, bonds, damping, boundaries, initial state.
#pragma once

#include "common/vec.hpp"
#include "dem_core/tool_motion.hpp"
#include "dem_core/tool_shape.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace kerf::dem {

enum class NormalLaw {
  linear,        // springs of constant stiffness
  hertz_mindlin, // elastic spheres; bonds are linear all the same
};

/// Constants of particles of one kind and of the contacts among them; in 2D all of them are per
/// metre of thickness. What follows from them is in contact_constants.hpp.
struct Material {
  static constexpr double unbreakable = std::numeric_limits<double>::infinity();

  double density = 0.0; // of the solid, kg/m³
  NormalLaw law = NormalLaw::linear;
  double friction = 0.0; // mu of contacts without bond

  // Linear springs, which bonds have by any law: the same for all contacts, or from a modulus and
  // the sizes.
  double normal_stiffness = 0.0;     // k_n, N/m
  double tangential_stiffness = 0.0; // k_t, N/m
  double contact_modulus = 0.0;      // E_c, Pa; 0: the stiffness is given
  double stiffness_ratio = 0.0;      // k_t / k_n with a contact modulus

  // Bonds: the weaker of strength and stress times cross-section counts.
  double tensile_strength = unbreakable; // R_n, N
  double shear_strength = unbreakable;   // R_t, N
  double tensile_stress = unbreakable;   // Pa
  double shear_stress = unbreakable;     // Pa
  double bond_radius_ratio = 0.0;        // of the smaller radius; 0: bonds without moments

  // Spheres of Hertz and Mindlin.
  double young_modulus = 0.0; // Pa
  double poisson_ratio = 0.0;

  double restitution = 1.0;      // of a collision; 1: no dashpots
  double rolling_friction = 0.0; // mu_r

  bool has_springs() const { return normal_stiffness > 0.0 || contact_modulus > 0.0; }
  bool operator==(const Material&) const = default;
};

/// What counts for contacts between two materials: both, as if they were of this kind. Their
/// densities do not count.
struct MaterialPair {
  std::uint8_t first = 0, second = 0; // 0: Settings::material, k: other_materials[k - 1]
  Material of_first, of_second;
  bool bonds = true; // may there be any
};

/// Where the tangential displacement of a step is measured.
enum class ShearIncrement {
  midpoint, // on the branch halfway through the step: reversible, energy error falls as dt²
  endpoint, // on the branch at its end, as YADE's ScGeom does: for comparison, first order in dt
};

enum class DampingKind {
  nonviscous,    // Rojek (2008) eqs 18-19: against the direction of motion
  componentwise, // as YADE's NewtonIntegrator: each component by the sign of its power
};

struct Damping {
  DampingKind kind = DampingKind::nonviscous;
  double translation = 0.0; // alpha_t, share of the resultant force
  double rotation = 0.0;    // alpha_r, share of the resultant moment

  bool is_on() const noexcept { return translation != 0.0 || rotation != 0.0; }
  /// Against the fastest motion a resultant grows by as much at most, and its stiffness with it.
  double stiffening() const noexcept { return 1.0 + std::max(translation, rotation); }
};

enum class Motion {
  fixed,    // does not move
  velocity, // constant velocity
  table,    // velocity that follows tables of times
  hann,     // displacement amplitude * (1 - cos(2 pi t / duration)) / 2 until t = duration
};

/// Motion that some particles are given, whatever the forces. Where two of them meet in one
/// component, the later one counts.
template <int dim> struct Prescription {
  Box<dim> box;                            // selects by the reference position
  std::uint8_t components = 0;             // bit a: axis a; bit dim: every rotation
  Motion motion = Motion::fixed;           // along the axes
  Vec<dim> velocity = Vec<dim>::Zero();    // of Motion::velocity, m/s
  std::array<TimeTable, dim> velocities{}; // of Motion::table, m/s
  Vec<dim> amplitude = Vec<dim>::Zero();   // of Motion::hann, m
  double duration = 0.0;                   // of Motion::hann, s
  Rot<dim> axis = Rot<dim>::UnitX();       // of each particle's own rotation, of any length
  TimeTable rotation_rate{};               // about it, rad/s
};

/// Force from outside on some particles; several of them add up.
template <int dim> struct AppliedForce {
  Box<dim> box;                       // selects by the reference position
  std::array<TimeTable, dim> force{}; // along each axis, N
  bool is_total = false; // shared by mass, so that all are accelerated alike; else on each particle
};

/// Particles that are joined to one rigid body; see clusters.hpp.
template <int dim> struct ClusterSettings {
  std::string name;
  std::optional<Box<dim>> box;    // its members, by the reference position,
  std::vector<std::uint32_t> ids; // or by what the user calls them
  bool is_free = true;
  /// Of a body that is not free, with the reference point at the centre unless has_reference; a
  /// free one begins with this velocity and rotation.
  ToolMotion<dim> motion;
  bool has_reference = false;
  // Instead of what follows from the members, which are taken not to overlap.
  std::optional<double> mass;                                                   // kg
  std::optional<Vec<dim>> centre;                                               // m
  std::optional<Eigen::Matrix<double, rotations<dim>, rotations<dim>>> inertia; // about it, kg m²
};

/// More mass and inertia than the particles have, which their weight does not feel.
struct MassScaling {
  double critical_step = 0.0; // that is wished, s; 0: the factor is given
  double factor = 1.0;        // of all masses
};

/// One-way displacement pulse amplitude * (1 + cos(2 pi z / length)) / 2, |z| < length / 2.
struct Pulse {
  double amplitude = 0.0;  // m
  double center = 0.0;     // position of z = 0 on the axis, m
  double length = 0.0;     // whole width, m
  double wave_speed = 0.0; // of long waves, m/s; negative: towards the negative axis
  double spacing = 0.0;    // of the lattice whose dispersion the velocities follow, m; 0: none
  int component = 0;       // of the displacement
  int axis = 0;            // along which it varies and travels
};

/// State at the start; several of them add up.
template <int dim> struct InitialCondition {
  std::optional<Box<dim>> box;          // nothing: all particles
  Vec<dim> velocity = Vec<dim>::Zero(); // m/s
  std::optional<Pulse> pulse;
};

/// Constants of the contacts of particles with a tool; in 2D per metre of thickness.
struct WallMaterial {
  double normal_stiffness = 0.0;     // k_n, N/m
  double tangential_stiffness = 0.0; // k_t, N/m
  double friction = 0.0;             // mu
  bool seated = false; // contacts of the start are free of stress, however deep they are
};

/// A rigid wall or tool.
template <int dim> struct ToolSettings {
  std::string name;
  ToolShape<dim> shape;
  ToolMotion<dim> motion;
  WallMaterial material;
};

/// Of the bonds at the start; tension is positive. The components are xx yy xy in 2D and
/// xx yy zz yz xz xy in 3D.
template <int dim> struct InSituStress {
  Eigen::Matrix<double, dim == 2 ? 3 : 6, 1> uniform = Eigen::Matrix < double, dim == 2 ? 3 : 6,
                                             1 > ::Zero(); // Pa
  /// Adds sigma_v = overburden + rho g depth along gravity and K0 sigma_v across it, as pressures.
  /// rho is the bulk density of the body.
  std::optional<double> K0;
  double surface = 0.0;    // where depth is zero: height against gravity, m
  double overburden = 0.0; // Pa
};

template <int dim> struct Settings {
  std::vector<Vec<dim>> positions;       // [n] centres in the reference configuration, m
  std::vector<double> radii;             // [n] m
  std::vector<std::uint32_t> ids;        // [n] what the user calls them; empty: their index
  Material material;                     // of all particles, but for
  std::vector<Material> other_materials; // at most 255 of them
  std::vector<std::uint8_t> material_of; // [n] 0: material, k: other_materials[k - 1]; empty: all 0
  std::vector<MaterialPair> pairs;       // other pairs are mixed, see materials.hpp
  bool bonds = true;                     // between neighbours at the start
  double gap_tolerance = 1e-3; // bonded when distance - (r_i + r_j) <= gap_tolerance (r_i + r_j)
  ShearIncrement shear_increment = ShearIncrement::midpoint;
  Damping damping;
  std::vector<Prescription<dim>> boundary;
  std::vector<AppliedForce<dim>> applied_forces;
  std::vector<InitialCondition<dim>> initial;
  Period<dim> period;
  std::vector<ToolSettings<dim>> tools;
  std::vector<ClusterSettings<dim>> clusters;
  std::optional<MassScaling> mass_scaling;
  std::optional<InSituStress<dim>> in_situ_stress;
  Vec<dim> gravity = Vec<dim>::Zero(); // of the particles; a free tool has its own force, m/s²
};

} // namespace kerf::dem
