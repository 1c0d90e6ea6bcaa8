// The keys of a participant: its model, and the motions that are prescribed to it.
#include "common/config/schema_rows.hpp"

#include <iterator>

namespace kerf::config {
namespace {

std::vector<Key> participant_keys(const std::string& kind) {
  using enum Type;
  const bool dem = kind == "dem";
  const std::string solver = dem ? R"("kerf-dem")" : R"("kerf-fem")";
  return {
      {"participants.*.kind", kind, text, "", required, one_of({"dem", "fem"}),
       dem ? R"("dem")" : R"("fem")", "dem for particles or fem for elements"},
      {"participants.*.solver", kind, text, "", solver, one_of({solver.substr(1, 8)}), solver,
       "the program that computes it; command instead starts one of your own"},
      {"participants.*.command", kind, texts, "", none, anything, R"(["python3", "mine.py"])",
       "the command line of your own solver, instead of solver"},
      {"participants.*.threads", kind, integer_or_auto, "", R"("auto")", in(from_one), "1",
       R"(the number of threads, or "auto" for a fair share of the machine)"},
  };
}

std::vector<Key> joined(std::vector<std::vector<Key>> parts) {
  std::vector<Key> keys;
  for (std::vector<Key>& part : parts)
    std::move(part.begin(), part.end(), std::back_inserter(keys));
  return keys;
}

/// Which particles there are.
std::vector<Key> particle_set_keys() {
  using enum Type;
  return {
      {"participants.*.particles", "dem", table, "", tables, anything, "particle set",
       "the particles: exactly one of lattice, file and packing"},
      {"participants.*.particles.lattice", "dem", optional_table, "", none, anything, "lattice",
       "a regular arrangement; its first particle is at the origin", live},
      {"participants.*.particles.lattice.type", "dem", text, "", required,
       one_of({"chain", "triangular", "square", "cubic", "fcc"}), R"("triangular")",
       "the arrangement: chain along x; triangular, square in 2D; cubic, fcc in 3D"},
      {"participants.*.particles.lattice.spacing", "dem", number, "m", required, in(above_zero),
       "1e-3", "the distance of nearest neighbours"},
      {"participants.*.particles.lattice.origin", "dem", vector, "m", required, anything,
       "[0.0, 0.0]", "the position of the first particle"},
      {"participants.*.particles.lattice.count", "dem", counts, "", required, in(from_one),
       "[80, 8]", "the number of particles along each axis; of fcc, of cells with 4 particles"},
      {"participants.*.particles.file", "dem", path, "", none, anything, R"("packing.txt")",
       "a packing in m: lines x y [z] r, legacy VTK, YADE's text or a LAMMPS dump"},
      {"participants.*.particles.radius", "dem", number, "m", none, in(above_zero), "0.5e-3",
       "the radius of lattice particles; half of the spacing when not given"},
  };
}

std::vector<Key> model_of_particles() {
  using enum Type;
  return {
      {"participants.*.bonds", "dem", table, "", tables, anything, "bonds",
       "which particles are bonded"},
      {"participants.*.bonds.kind", "dem", text, "", R"("brittle")", one_of({"brittle", "none"}),
       R"("brittle")", "brittle bonds between neighbours at the start, or none: grains"},
      {"participants.*.bonds.gap_tolerance", "dem", number, "", "0.001", in(from_zero), "1e-3",
       "the largest gap that is bonded at the start, over the sum of the two radii"},
      {"participants.*.bonds.coordination_number", "dem", number, "", none, in(above_zero), "5.4",
       "instead of gap_tolerance: 2 bonds / particles, which the tolerance follows from"},
      {"participants.*.bonds.shear_increment", "dem", text, "", R"("midpoint")",
       one_of({"midpoint", "endpoint"}), R"("midpoint")",
       "where a step measures tangential motion: midpoint conserves energy, endpoint is YADE's "
       "way"},
      {"participants.*.damping", "dem", table, "", tables, anything, "damping",
       "numerical damping"},
      {"participants.*.damping.kind", "dem", text, "", R"("nonviscous")",
       one_of({"nonviscous", "componentwise"}), R"("nonviscous")",
       "the law: nonviscous is a share of the resultant, against the motion; componentwise YADE's"},
      {"participants.*.damping.translation", "dem", number, "", "0.0", in(share), "0.2",
       "the share of the resultant force that opposes the motion"},
      {"participants.*.damping.rotation", "dem", number, "", "0.0", in(share), "0.2",
       "the share of the resultant moment that opposes the rotation"},
  };
}

std::vector<Key> watch_of_particles() {
  using enum Type;
  return {
      {"participants.*.domain", "dem", box, "m", none, anything, "[[-1.0, -1.0], [1.0, 1.0]]",
       "the lower and upper corner of a box that no particle's centre may leave; the run stops "
       "then"},
      {"participants.*.probes", "dem", list, "", empty, anything, "probe",
       "a box whose mean stress, strain and motion are recorded"},
      {"participants.*.probes[].name", "dem", name, "", required, anything, R"("middle")",
       "a name, used once"},
      {"participants.*.probes[].box", "dem", box, "m", required, anything,
       "[[1e-3, 1e-3], [4e-3, 6e-3]]", "its lower and upper corner, fixed in space"},
  };
}

/// What acts on particles from outside, beside their weight.
std::vector<Key> load_keys() {
  using enum Type;
  return {
      {"participants.*.loads", "dem", list, "", empty, anything, "load",
       "a force on particles; several are added"},
      {"participants.*.loads[].box", "dem", box, "m", required, anything,
       "[[-1.0, -1.0], [1.0, 1.0]]",
       "the lower and upper corner around the particles it acts on, before they move"},
      {"participants.*.loads[].force", "dem", vector, "N", none, anything, "[0.0, -1e3]",
       "the force; in 2D per metre of thickness", live},
      {"participants.*.loads[].forces", "dem", vectors_of_time, "s, N", none, anything,
       "[[0.0, 0.0, 0.0], [1e-5, 0.0, -1e3]]",
       "instead of force: a table of it, linear between its times and constant beyond"},
      {"participants.*.loads[].distribution", "dem", text, "", R"("each")",
       one_of({"each", "by_mass"}), R"("by_mass")",
       "how it is meant: the force on each particle, or a total that they share by mass"},
  };
}

std::vector<Key> in_situ_keys(const std::string& kind) {
  using enum Type;
  const bool dem = kind == "dem";
  const std::string key = "participants.*.in_situ_stress";
  return {
      {key, kind, optional_table, "", none, anything, "in-situ stress",
       "stress that the body has at the start, in equilibrium"},
      {key + ".stress", kind, numbers, "Pa", none, anything,
       dem ? "[-5e6, -10e6, 0.0]" : "[-5e6, -10e6, -3e6, 0.0]",
       dem ? "its mean: xx yy xy, in 3D xx yy zz yz xz xy; compression is negative"
           : "the stress everywhere: xx yy zz xy, in 3D xx yy zz yz xz xy; compression is "
             "negative"},
      {key + ".K0", kind, number, "", none, in(from_zero), "0.5",
       "instead of stress: the horizontal over the vertical one, which is rho g depth"},
      {key + ".surface", kind, number, "m", none, anything, "100.0",
       "with K0 the height of the ground, against gravity, where depth is zero"},
      {key + ".overburden", kind, number, "Pa", "0.0", in(from_zero), "1e6",
       "with K0 the vertical pressure on the ground"},
  };
}

std::vector<Key> mass_scaling_keys(const std::string& kind) {
  using enum Type;
  const std::string parts = kind == "dem" ? "particles" : "elements";
  return {
      {"participants.*.mass_scaling", kind, optional_table, "", none, anything, "mass scaling",
       "more inertia than the " + parts + " have, for a larger time step; static results stay"},
      {"participants.*.mass_scaling.critical_step", kind, number, "s", none, in(above_zero), "1e-6",
       "the critical step that is wished: " + parts + " with a smaller one become heavier"},
      {"participants.*.mass_scaling.factor", kind, number, "", none, in(from_one), "100.0",
       "instead of critical_step: the factor of all masses"},
  };
}

std::vector<Key> motion_keys(const std::string& kind) {
  using enum Type;
  const bool dem = kind == "dem";
  const std::string everywhere = "[[-1.0, -1.0], [1.0, 1.0]]";
  const std::vector<Key> particle_motion = {
      {"participants.*.boundary[].rotation", kind, optional_table, "", none, anything, "rotation",
       "the rotation of each particle about its own centre"},
      {"participants.*.boundary[].rotation.axis", kind, vector, "", none, anything,
       "[0.0, 0.0, 1.0]", "the direction of the axis; 3D only"},
      {"participants.*.boundary[].rotation.rate", kind, number, "rad/s", none, anything, "0.0",
       "the rate"},
      {"participants.*.boundary[].rotation.rates", kind, numbers_of_time, "s, rad/s", none,
       anything, "[[0.0, 0.0], [1e-5, 10.0]]", "a table of the rate, linear between its times"},
  };
  std::vector<Key> keys = {
      {"participants.*.boundary", kind, list, "", empty, anything, "boundary",
       "a prescribed motion"},
      {"participants.*.boundary[].box", kind, box, "m", dem ? required : none, anything,
       dem ? "[[-1e-4, -1e-4], [6e-4, 8e-3]]" : everywhere,
       "the lower and upper corner around the points that it holds, before they move"},
      {"participants.*.boundary[].components", kind, texts, "", none,
       dem ? one_of({"x", "y", "z", "rotation"}) : one_of({"x", "y", "z"}), R"(["x"])",
       "the components that it prescribes; every displacement when not given"},
      {"participants.*.boundary[].motion", kind, text, "", required,
       dem ? one_of({"fixed", "velocity", "hann"})
           : one_of({"fixed", "symmetry", "velocity", "displacement", "hann"}),
       dem ? R"("hann")" : R"("fixed")",
       dem ? "the motion: fixed, a velocity, or one hann pulse of displacement"
           : "the motion: fixed, fixed along the normal of a plane of symmetry, a velocity, a "
             "displacement, or one hann pulse of it"},
      {"participants.*.boundary[].velocity", kind, vector, "m/s", none, anything, "[1.0, 0.0]",
       "the velocity of motion = \"velocity\""},
      {"participants.*.boundary[].velocities", kind, vectors_of_time, "s, m/s", none, anything,
       "[[0.0, 0.0, 0.0], [1e-5, 1.0, 0.0]]",
       "instead of velocity: a table of it, linear between its times and constant beyond"},
      {"participants.*.boundary[].amplitude", kind, vector, "m", none, anything, "[1e-8, 0.0]",
       "the largest displacement of motion = \"hann\"", dem},
      {"participants.*.boundary[].duration", kind, number, "s", none, in(above_zero), "1e-5",
       "how long the pulse of motion = \"hann\" takes", dem},
      {"participants.*.initial", kind, list, "", empty, anything, "initial motion",
       "a motion at the start; several are added"},
      {"participants.*.initial[].box", kind, box, "m", none, anything, everywhere,
       "the lower and upper corner around its points; all when not given"},
      {"participants.*.initial[].kind", kind, text, "", required, one_of({"velocity", "pulse"}),
       R"("velocity")",
       "what it sets: a uniform velocity, or a one-way Hann pulse of displacement"},
      {"participants.*.initial[].velocity", kind, vector, "m/s", none, anything, "[0.0, 0.0]",
       "the velocity of kind = \"velocity\"", live},
      {"participants.*.initial[].amplitude", kind, number, "m", none, anything, "1e-8",
       "the largest displacement of the pulse"},
      {"participants.*.initial[].center", kind, number, "m", none, anything, "0.02",
       "where along the axis the pulse is"},
      {"participants.*.initial[].length", kind, number, "m", none, in(above_zero), "0.016",
       "the full width of the pulse"},
      {"participants.*.initial[].wave_speed", kind, number, "m/s", none, anything, "2424.0",
       "the speed of the pulse; negative against the axis"},
      {"participants.*.initial[].spacing", kind, number, "m", "0.0", in(from_zero), "1e-3",
       "the distance of the points along the axis, for their own dispersion; 0 for a continuum"},
      {"participants.*.initial[].component", kind, text, "", R"("x")", one_of({"x", "y", "z"}),
       R"("x")", "the direction of the displacement"},
      {"participants.*.initial[].axis", kind, text, "", R"("x")", one_of({"x", "y", "z"}), R"("x")",
       "the axis along which the pulse travels"},
  };
  const auto after_velocities = keys.begin() + 6;
  if (dem) {
    keys.insert(after_velocities, particle_motion.begin(), particle_motion.end());
  } else {
    keys.insert(
        after_velocities,
        {"participants.*.boundary[].displacements", kind, vectors_of_time, "s, m", none, anything,
         "[[0.0, 0.0, 0.0], [1e-5, 1e-6, 0.0]]",
         "the displacement of motion = \"displacement\", from zero: a table, linear between "
         "its times and constant beyond"});
    keys.insert(keys.begin() + 1,
                {"participants.*.boundary[].tag", kind, text, "", none, anything, R"("right")",
                 "the tag of the boundary that it holds; exactly one of tag and box", live});
  }
  return keys;
}

} // namespace

std::vector<Key> particle_keys() {
  return joined({participant_keys("dem"), particle_set_keys(), packing_keys(), material_keys(),
                 model_of_particles(), tool_keys(), motion_keys("dem"), load_keys(), cluster_keys(),
                 in_situ_keys("dem"), mass_scaling_keys("dem"), watch_of_particles()});
}

std::vector<Key> mesh_keys() {
  return joined({participant_keys("fem"), element_keys(), solid_keys(), motion_keys("fem"),
                 action_keys(), in_situ_keys("fem"), mass_scaling_keys("fem")});
}

} // namespace kerf::config
