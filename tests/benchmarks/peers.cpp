#include "tests/benchmarks/peers.hpp"

#include <fmt/format.h>
#include <fmt/os.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

/// Of the bonds in LAMMPS, which has one length for all bonds of a type.
constexpr int length_classes = 10'000;

struct Code {
  const char* name;
  const char* program;
  bool bonds;                 // can hold bonds
  std::size_t most_particles; // that it sets up in reasonable time and memory
};
constexpr Code all_codes[] = {{"lammps", "lmp", true, 1'000'000},
                              {"liggghts", "liggghts", false, 1'000'000},
                              {"yade", "yade", true, 100'000}};

/// LAMMPS knows spheres only: a disc is a sphere of the same mass, per metre of thickness.
template <int dim> double sphere_density(double density, double radius) {
  return dim == 2 ? density * 3.0 / (4.0 * radius) : density;
}

/// The box around the model; free faces are so far away that no particle comes there.
template <int dim> Box<3> box_of(const Workload& workload) {
  const double edge = edge_of<dim>(workload), margin = workload.bonded ? 0.1 * edge : 0.0;
  Box<3> box{Vec<3>::Constant(-margin), Vec<3>::Constant(edge + margin)};
  if (dim == 2) { // thin, but wider than a disc
    box.lower[2] = -1e-3;
    box.upper[2] = 1e-3;
  }
  return box;
}

template <int dim> Vec<3> in_space(const Vec<dim>& vector) {
  Vec<3> result = Vec<3>::Zero();
  result.head<dim>() = vector;
  return result;
}

} // namespace

template <int dim>
Peers<dim>::Peers(const Workload& workload, const dem::Settings<dim>& settings,
                  const dem::Engine<dim>& engine, double time_step)
    : workload_(workload) {
  for (const Code& code : all_codes) {
    if ((workload.bonded && !code.bonds) || workload.particles > code.most_particles)
      continue;
    if (!is_installed(code.program))
      throw std::runtime_error(fmt::format("{} is not installed, which --peers needs.\n  Fix: "
                                           "./kerf bench dem --peers --yes installs it",
                                           code.program));
    codes_.push_back(code.name);
  }
  const double largest = *std::ranges::max_element(settings.radii); // m
  variables_ = fmt::format(
      " -var data {}/particles.data -var dimension {} -var "
      "time_step {} -var kn {} -var kt {} -var friction {} -var reach {}",
      folder_.path().string(), dim, time_step, settings.material.normal_stiffness,
      settings.material.tangential_stiffness, settings.material.friction, 2.0 * largest);
  write_yade_model(settings, engine, time_step);
  write_lammps_data(settings, engine, workload.bonded);
}

template <int dim>
void Peers<dim>::write_yade_model(const dem::Settings<dim>& settings,
                                  const dem::Engine<dim>& engine, double time_step) const {
  const dem::Particles<dim>& particles = engine.particles();
  const dem::Material& material = settings.material;
  nlohmann::json model = {{"dimension", dim},
                          {"bonded", workload_.bonded},
                          {"edge", edge_of<dim>(workload_)},
                          {"gap_tolerance", settings.gap_tolerance},
                          {"time_step", time_step},
                          {"normal_stiffness", material.normal_stiffness},
                          {"tangential_stiffness", material.tangential_stiffness},
                          {"friction", material.friction},
                          {"tensile_strength", material.tensile_strength},
                          {"shear_strength", material.shear_strength}};
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const Vec<3> x = in_space<dim>(particles.reference[i]),
                 v = in_space<dim>(particles.velocity[i]);
    model["position"].push_back({x[0], x[1], x[2]});
    model["velocity"].push_back({v[0], v[1], v[2]});
  }
  model["radius"] = particles.radius;
  model["mass"] = particles.mass;
  model["inertia"] = particles.inertia;
  std::ofstream(folder_.path() / "model.json") << model;
}

template <int dim>
void Peers<dim>::write_lammps_data(const dem::Settings<dim>& settings,
                                   const dem::Engine<dim>& engine, bool with_bonds) const {
  const dem::Particles<dim>& particles = engine.particles();
  const dem::Contacts<dim>& contacts = engine.contacts();
  const double largest = 2.0 * (1.0 + settings.gap_tolerance) *
                         *std::ranges::max_element(settings.radii); // bond length, m
  const Box<3> box = box_of<dim>(workload_);
  fmt::ostream file = fmt::output_file((folder_.path() / "particles.data").string());
  file.print("kerf bench dem {}\n\n{} atoms\n1 atom types\n", workload_.name, engine.size());
  if (with_bonds)
    file.print("{} bonds\n{} bond types\n", engine.bonds(), length_classes);
  for (int a = 0; a < 3; ++a)
    file.print("{} {} {}lo {}hi\n", box.lower[a], box.upper[a], "xyz"[a], "xyz"[a]);
  if (with_bonds) {
    file.print("\nBond Coeffs\n\n"); // LAMMPS leaves out the half: k_n / 2
    for (int type = 1; type <= length_classes; ++type)
      file.print("{} {} {}\n", type, 0.5 * settings.material.normal_stiffness,
                 largest * (type - 0.5) / length_classes);
  }
  file.print("\nAtoms\n\n");
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const Vec<3> x = in_space<dim>(particles.reference[i]);
    const double diameter = 2.0 * particles.radius[i];
    const double density = sphere_density<dim>(particles.density[i], particles.radius[i]);
    if (with_bonds) // atom_style hybrid sphere bond
      file.print("{} 1 {} {} {} {} {} 1\n", i + 1, x[0], x[1], x[2], diameter, density);
    else
      file.print("{} 1 {} {} {} {} {}\n", i + 1, diameter, density, x[0], x[1], x[2]);
  }
  file.print("\nVelocities\n\n");
  for (std::size_t i = 0; i < engine.size(); ++i) {
    const Vec<3> v = in_space<dim>(particles.velocity[i]);
    file.print("{} {} {} {} 0 0 0\n", i + 1, v[0], v[1], v[2]);
  }
  if (!with_bonds)
    return;
  file.print("\nBonds\n\n");
  std::size_t bond = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (contacts.bonded[k])
      file.print("{} {} {} {}\n", ++bond,
                 1 + static_cast<int>(contacts.rest_length[k] / largest * length_classes),
                 contacts.first[k] + 1, contacts.second[k] + 1);
}

template <int dim>
double Peers<dim>::seconds_per_step(const std::string& code, int threads, int steps) const {
  std::string command;
  if (code == "yade")
    command = fmt::format("yade -n -x -j{} {}/yade_steps.py {}/model.json {}", threads,
                          KERF_PEERS_FOLDER, folder_.path().string(), steps);
  else
    command = fmt::format("mpirun --allow-run-as-root --oversubscribe -np {} {} -in "
                          "{}/{}.{} -log none {} -var steps {} -var warm_up {}",
                          threads, code == "lammps" ? "lmp" : "liggghts", KERF_PEERS_FOLDER,
                          workload_.bonded ? "bonded" : "friction", code, variables_, steps,
                          steps / 10 + 5);
  // "Loop time of 1.234 on 2 procs for 100 steps with 50000 atoms"; the last one is timed.
  return loop_time(output_of("cd " + folder_.path().string() + " && " + command)) / steps;
}

template class Peers<2>;
template class Peers<3>;

} // namespace kerf::benchmarks
