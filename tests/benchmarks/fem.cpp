#include "tests/benchmarks/fem.hpp"

#include "tests/benchmarks/fem_limit.hpp"
#include "tests/benchmarks/fem_models.hpp"
#include "tests/benchmarks/fem_peers.hpp"
#include "tests/benchmarks/memory.hpp"
#include "tests/benchmarks/speeds.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

constexpr double element_steps = 20e6; // in a timed block
constexpr std::size_t large_factor = 8;

int steps_of(const FemOptions& options, std::size_t elements) {
  const double steps = element_steps / static_cast<double>(elements);
  return options.steps > 0 ? options.steps : std::max(10, static_cast<int>(steps));
}

int warm_up_of(int steps) {
  return 5 + steps / 10;
}

/// Makes some steps to warm up, then times others.
/// @param engine  a copy, so that every measurement times the same steps
template <int dim> double seconds_per_step(fem::Engine<dim> engine, int steps) {
  for (int n = 0; n < warm_up_of(steps); ++n)
    engine.integrate();
  const double start = omp_get_wtime();
  for (int n = 0; n < steps; ++n)
    engine.integrate();
  const double seconds = (omp_get_wtime() - start) / steps;
  if (engine.first_non_finite())
    throw std::runtime_error("the timed body has blown up");
  return seconds;
}

/// One workload with one law.
template <int dim> struct Model {
  std::string name, law;
  ElementWork work;
  fem::Engine<dim> engine;
  Speeds speeds{};
};

template <int dim>
std::vector<Model<dim>> models_of(const FemWorkload& workload, const FemOptions& options,
                                  const fem::Mesh<dim>& mesh, nlohmann::json& figures) {
  const double elements = static_cast<double>(mesh.num_elements());
  std::vector<Model<dim>> models;
  models.reserve(options.laws.size());
  for (const std::string& law : options.laws) {
    std::string name = law == "total_strain" ? workload.name : workload.name + "_" + law;
    if (options.large)
      name += "_large";
    const double before = resident_memory();
    models.push_back({name, law,
                      work_of(workload, law, static_cast<double>(mesh.num_nodes()) / elements),
                      engine_of<dim>(workload, law, mesh)});
    const double resident = (resident_memory() - before) / elements;
    const ElementWork& work = models.back().work;
    fmt::print("{}: {:.0f} bytes an element resident; a step takes at least {:.0f} operations and "
               "{:.0f} bytes an element\n",
               name, resident, work.operations, work.bytes);
    figures["memory_" + name]["1"]["kerf"] = resident;
  }
  return models;
}

/// The other codes for a workload with the laws that are chosen, after they have shown that they
/// compute the same.
template <int dim>
std::vector<FemPeer> peers_of(const FemWorkload& workload, const FemOptions& options) {
  constexpr double tolerance = 1e-9; // of the largest displacement; rounding is a millionth of it
  std::vector<FemPeer> peers;
  for (const FemPeer& peer : fem_peers(workload)) {
    if (std::ranges::none_of(options.laws,
                             [&](const std::string& law) { return peer.computes(law); }))
      continue;
    const double difference =
        difference_from<dim>(peer, workload, std::ranges::max(options.threads));
    fmt::print("{}, {}: on a small mesh {} is {:.1e} of the largest displacement off kerf's\n",
               workload.name, peer.law, peer.name, difference);
    if (!(difference <= tolerance))
      throw std::runtime_error(fmt::format("{} does not compute the same as kerf", peer.name));
    peers.push_back(peer);
  }
  return peers;
}

template <int dim>
void run(const FemWorkload& workload, const FemOptions& options, nlohmann::json& figures) {
  omp_set_num_threads(omp_get_num_procs());
  const fem::Mesh<dim> mesh =
      mesh_of<dim>(workload.shape, workload.elements * (options.large ? large_factor : 1));
  const std::size_t elements = mesh.num_elements();
  fmt::print("\n{}: {} elements, {} nodes\n", workload.name, elements, mesh.num_nodes());
  std::vector<Model<dim>> models = models_of(workload, options, mesh, figures);
  std::vector<FemPeer> peers;
  if (options.peers)
    peers = peers_of<dim>(workload, options);
  std::optional<FemPeerModel<dim>> peer_model; // files, if somebody needs them
  if (!peers.empty())
    peer_model.emplace(workload, mesh);

  const int steps = steps_of(options, elements);
  const int peer_steps = std::max(10, steps / 4); // slower
  const auto speed = [&](double seconds) { return 1e-6 * static_cast<double>(elements) / seconds; };
  for (int round = 0; round < options.rounds; ++round)
    for (const int threads : options.threads) {
      omp_set_num_threads(threads);
      for (Model<dim>& model : models) {
        model.speeds[threads]["kerf"].push_back(speed(seconds_per_step(model.engine, steps)));
        model.speeds[threads]["limit"].push_back(limit_of(model.work, elements));
      }
      for (const FemPeer& peer : peers) {
        fmt::print(stderr, "{}: round {}, {} threads, {}, {}…\n", workload.name, round + 1, threads,
                   peer.name, peer.law);
        const double of_peer =
            speed(peer_model->seconds_per_step(peer, threads, peer_steps, warm_up_of(peer_steps)));
        for (Model<dim>& model : models)
          if (peer.computes(model.law))
            model.speeds[threads][peer.name].push_back(of_peer);
      }
    }
  for (const Model<dim>& model : models)
    print(model.name, model.speeds, figures);
}

template <int dim>
void sweep(const FemWorkload& workload, const FemOptions& options, nlohmann::json& figures) {
  const std::string& law = options.laws.front();
  std::vector<double> costs; // of an element-step, ns
  fmt::print("\n{}, {}, one thread, {} rounds\n{:>10} {:>24}\n", workload.name, law, options.rounds,
             "elements", "ns per element-step");
  for (const std::size_t about : {10'000, 30'000, 100'000, 300'000, 1'000'000, 3'000'000}) {
    const fem::Engine<dim> engine =
        engine_of<dim>(workload, law, mesh_of<dim>(workload.shape, about));
    const std::size_t elements = engine.mesh().num_elements();
    std::vector<double> times;
    for (int round = 0; round < options.rounds; ++round)
      times.push_back(1e9 / static_cast<double>(elements) *
                      seconds_per_step(engine, steps_of(options, elements)));
    costs.push_back(median(times));
    fmt::print("{:>10} {:>24.1f}\n", elements, costs.back());
    figures[fmt::format("sweep_{}_{}", workload.name, elements)]["1"]["kerf"] = 1e3 / costs.back();
  }
  const auto [least, most] = std::ranges::minmax(costs);
  fmt::print("most / least: {:.2f}\n", most / least);
}

/// Calls act(workload, std::integral_constant of its dimension) for those that are chosen.
template <class Act> void for_chosen(const std::vector<std::string>& names, Act act) {
  for (const FemWorkload& workload : fem_workloads())
    if (names.empty() || std::ranges::find(names, workload.name) != names.end()) {
      if (fem::dimension_of(workload.shape) == 2)
        act(workload, std::integral_constant<int, 2>());
      else
        act(workload, std::integral_constant<int, 3>());
    }
}

FemOptions with_laws(FemOptions options) {
  if (options.laws.empty())
    options.laws.assign(fem_laws.begin(), fem_laws.end());
  return options;
}

} // namespace

nlohmann::json fem(const FemOptions& given) {
  const FemOptions options = with_laws(given);
  fmt::print("{} rounds in turn. 10^6 element-steps per second, the median (least..most):\n"
             "{:<32} {:>7} {:<9} {:>8} {:>28}\n",
             options.rounds, "workload", "threads", "code", "speed", "kerf / code");
  nlohmann::json figures;
  for_chosen(options.workloads, [&](const FemWorkload& workload, auto dim) {
    run<dim()>(workload, options, figures);
  });
  return figures;
}

nlohmann::json fem_sweep(const FemOptions& given) {
  FemOptions options = with_laws(given);
  if (options.workloads.empty())
    options.workloads = {"hex8"};
  omp_set_num_threads(1);
  nlohmann::json figures;
  for_chosen(options.workloads, [&](const FemWorkload& workload, auto dim) {
    sweep<dim()>(workload, options, figures);
  });
  return figures;
}

} // namespace kerf::benchmarks
