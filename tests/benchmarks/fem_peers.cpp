#include "tests/benchmarks/fem_peers.hpp"

#include "tests/cases/fem_bodies.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

constexpr const char* python = "/usr/bin/python3"; // whose packages Debian's are

template <class Value>
void write(const std::filesystem::path& path, const std::vector<Value>& values) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

std::string missing(const char* code) {
  return fmt::format("{} is not installed, which --peers needs.\n  Fix: ./kerf bench fem --peers "
                     "--yes installs it",
                     code);
}

void build_dealii() {
  if (!std::filesystem::exists("/usr/include/deal.II"))
    throw std::runtime_error(missing("deal.II"));
  if (!std::filesystem::exists(KERF_DEALII_BUILD "/kerf-peer-dealii"))
    fmt::print(stderr, "building the program for deal.II, once: it takes minutes and 2.5 GB…\n");
  output_of(fmt::format("cmake -S {0}/dealii -B {1} -G Ninja -DCMAKE_BUILD_TYPE=Release && ninja "
                        "-C {1}",
                        KERF_PEERS_FOLDER, KERF_DEALII_BUILD));
}

} // namespace

std::vector<FemPeer> fem_peers(const FemWorkload& workload) {
  if (workload.formulation != fem::Formulation::full)
    return {}; // neither has one-point elements with hourglass control
  if (std::system(fmt::format("{} -c 'import dolfinx' 2> /dev/null", python).c_str()) != 0)
    throw std::runtime_error(missing("FEniCSx"));
  build_dealii();
  return {
      {"fenicsx", "linear"}, {"petsc", "linear"}, {"dealii", "linear"}, {"fenicsx", "neo_hookean"}};
}

template <int dim>
FemPeerModel<dim>::FemPeerModel(const FemWorkload& workload, const fem::Mesh<dim>& mesh)
    : size_(mesh.positions.size()) {
  const auto& rock = cases::rock;
  const std::filesystem::path& folder = folder_.path();
  write(folder / "positions.bin", mesh.positions);
  write(folder / "elements.bin", mesh.blocks.front().nodes);
  write(folder / "velocity.bin", velocity_of<dim>(mesh));
  std::ofstream(folder / "model.json") << nlohmann::json{{"shape", fem::name_of(workload.shape)},
                                                         {"dimension", dim},
                                                         {"corners", fem::nodes_of(workload.shape)},
                                                         {"nodes", mesh.num_nodes()},
                                                         {"lambda", rock.moduli.lambda},
                                                         {"mu", rock.moduli.mu},
                                                         {"density", rock.density},
                                                         {"time_step", fem_time_step()}};
}

template <int dim>
double FemPeerModel<dim>::seconds_per_step(const FemPeer& peer, int threads, int steps,
                                           int warm_up) {
  std::string program;
  if (peer.name == "dealii")
    program = fmt::format("{}/kerf-peer-dealii {}", KERF_DEALII_BUILD, folder_.path().string());
  else
    program = fmt::format("{} {}/fenicsx_steps.py {} {} {}", python, KERF_PEERS_FOLDER,
                          folder_.path().string(), peer.name == "petsc" ? "stiffness" : "assembled",
                          peer.law);
  return loop_time(output_of(fmt::format("OMP_NUM_THREADS=1 mpirun --allow-run-as-root "
                                         "--oversubscribe --bind-to none -np {} {} {} {}",
                                         threads, program, steps, warm_up))) /
         steps;
}

template <int dim> std::vector<double> FemPeerModel<dim>::displacement() const {
  std::vector<double> values(size_);
  std::ifstream file(folder_.path() / "displacement.bin", std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(values.data()),
                 static_cast<std::streamsize>(size_ * sizeof(double))))
    throw std::runtime_error("a code did not write its displacements");
  return values;
}

template <int dim>
double difference_from(const FemPeer& peer, const FemWorkload& workload, int threads) {
  constexpr std::size_t elements = 500;
  constexpr int steps = 20, warm_up = 5;
  const fem::Mesh<dim> mesh = mesh_of<dim>(workload.shape, elements);
  FemPeerModel<dim> model(workload, mesh);
  model.seconds_per_step(peer, threads, steps, warm_up);
  fem::Engine<dim> engine = engine_of<dim>(workload, peer.law, mesh);
  for (int n = 0; n < steps + warm_up; ++n)
    engine.integrate();
  const std::vector<double> ours = engine.displacement(), theirs = model.displacement();
  double difference = 0.0, most = 0.0; // m
  for (std::size_t k = 0; k < ours.size(); ++k) {
    difference = std::max(difference, std::abs(ours[k] - theirs[k]));
    most = std::max(most, std::abs(ours[k]));
  }
  return difference / most;
}

template class FemPeerModel<2>;
template class FemPeerModel<3>;
template double difference_from<2>(const FemPeer&, const FemWorkload&, int);
template double difference_from<3>(const FemPeer&, const FemWorkload&, int);

} // namespace kerf::benchmarks
