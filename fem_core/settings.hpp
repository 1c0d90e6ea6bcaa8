// What can be set of a finite element body besides its mesh.
#pragma once

#include "common/time_table.hpp"
#include "common/vec.hpp"
#include "fem_core/material.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace kerf::fem {

/// How a prescribed displacement goes on in time; t = 0 is the start of the run.
enum class Motion {
  fixed,              // 0
  symmetry,           // 0 along the normal of the faces, which are in one plane across an axis
  velocity,           // velocity * t
  hann,               // amplitude (1 - cos(2 pi t / duration)) / 2 for 0 <= t <= duration, else 0
  displacement_table, // table, m
  velocity_table,     // table, m/s
};

/// Motion that is prescribed for some nodes, selected either by a tag or by a box.
template <int dim> struct BoundarySetting {
  std::string tag; // empty: by the box
  std::optional<Box<dim>> box{};
  std::array<bool, dim> components;
  Motion motion = Motion::fixed;
  Vec<dim> velocity = Vec<dim>::Zero();  // m/s
  Vec<dim> amplitude = Vec<dim>::Zero(); // m
  double duration = 0.0;                 // s
  std::array<TimeTable, dim> table{};
};

/// What pushes a body.
enum class LoadKind {
  force,    // N in all, spread over faces by their area, or evenly over the nodes of other tags
  traction, // Pa of the reference area
  pressure, // Pa on the deformed faces, against their outward normal; value[0]
};

/// Forces on nodes, selected by a tag of faces or nodes, or by a box (force only).
template <int dim> struct LoadSetting {
  std::string tag; // empty: by the box
  std::optional<Box<dim>> box{};
  LoadKind kind = LoadKind::force;
  std::array<TimeTable, dim> value{};
};

/// A plane wave that comes in through an absorbing boundary.
template <int dim> struct IncomingWave {
  Vec<dim> direction = Vec<dim>::Zero();    // of travel
  Vec<dim> polarization = Vec<dim>::Zero(); // along the direction: P, across it: S
  Vec<dim> origin = Vec<dim>::Zero();       // where the table counts its time, m
  TimeTable velocity{};                     // of the particles, m/s
};

/// Faces that let waves out.
template <int dim> struct AbsorbingSetting {
  std::string tag;
  std::optional<IncomingWave<dim>> wave{};
};

/// A rigid plane that nodes do not pass; it may move along its normal.
template <int dim> struct WallSetting {
  std::string tag;                    // of the nodes that are held back
  Vec<dim> point = Vec<dim>::Zero();  // of the plane at the start, m
  Vec<dim> normal = Vec<dim>::Zero(); // towards the body
  TimeTable velocity{};               // along the normal, m/s
  double friction = 0.0;
};

/// Velocity that the nodes start with.
template <int dim> struct InitialVelocity {
  Vec<dim> velocity = Vec<dim>::Zero(); // m/s
};

/// Displacement pulse that starts already on its way along an axis:
/// u(z) = amplitude (1 + cos(2 pi z / length)) / 2 for |z| < length / 2, z = x - center.
struct InitialPulse {
  double amplitude = 0.0;  // m
  double center = 0.0;     // m
  double length = 0.0;     // m, > 0
  double wave_speed = 0.0; // m/s; negative: it travels towards lower coordinates
  /// Element size along the axis, m: the velocity is then the one with which lumped linear
  /// elements of this size carry the pulse on. 0: that of the continuum.
  double spacing = 0.0;
  int component = 0; // of the displacement
  int axis = 0;
};

/// Initial conditions add up.
template <int dim> struct InitialSetting {
  std::optional<Box<dim>> box; // none: everywhere
  std::optional<InitialVelocity<dim>> velocity;
  std::optional<InitialPulse> pulse;
};

/// What the elements of a region, or with their centre in a box, are made of; without either, all.
/// Where several settings meet, the last one counts.
template <int dim> struct MaterialSetting {
  Material material;
  std::string region{};
  std::optional<Box<dim>> box{};
};

/// Stress that a body begins with, in equilibrium with what holds it and with its weight: the same
/// everywhere, or growing with the depth.
template <int dim> struct InSituStress {
  Symmetric<double, dim> stress{}; // Pa, tension positive; without K0
  /// Horizontal over vertical stress, which is -(overburden + rho g depth) along gravity.
  std::optional<double> K0{};
  double surface = 0.0;    // height against gravity where the depth is zero, m
  double overburden = 0.0; // Pa, on the surface
};

/// More inertia than the material has, for a larger time step. Waves are slower; weight and static
/// results are not changed. One of the two:
struct MassScaling {
  double critical_step = 0.0; // s: elements with a smaller one of their own become heavier
  double factor = 1.0;        // of all masses
};

template <int dim> struct Settings {
  std::vector<MaterialSetting<dim>> materials;
  Plane plane = Plane::strain; // of 2D
  std::vector<BoundarySetting<dim>> boundary{};
  std::vector<InitialSetting<dim>> initial{};
  std::vector<LoadSetting<dim>> loads{};
  std::vector<AbsorbingSetting<dim>> absorbing{};
  std::vector<WallSetting<dim>> walls{};
  std::optional<InSituStress<dim>> in_situ_stress{};
  Vec<dim> gravity = Vec<dim>::Zero(); // m/s²
  double mass_damping = 0.0;           // a of the force -a m v, 1/s
  double local_damping = 0.0;          // share of the resultant that opposes the motion, 0 to 1
  /// Everything that is free stops behind each peak of the kinetic energy, and starts anew: a way
  /// to a static state that needs no number.
  bool kinetic_damping = false;
  std::optional<MassScaling> mass_scaling{};
};

} // namespace kerf::fem
