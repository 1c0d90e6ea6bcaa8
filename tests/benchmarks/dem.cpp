#include "tests/benchmarks/dem.hpp"

#include "tests/benchmarks/dem_models.hpp"
#include "tests/benchmarks/dem_timing.hpp"
#include "tests/benchmarks/memory.hpp"
#include "tests/benchmarks/peers.hpp"
#include "tests/benchmarks/speeds.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

int steps_of(const DemOptions& options, std::size_t particles) {
  return options.steps > 0 ? options.steps : static_cast<int>(20'000'000 / particles);
}

/// Contacts that carry force, a particle.
template <int dim> double contacts_per_particle(const dem::Engine<dim>& engine) {
  const dem::Contacts<dim>& contacts = engine.contacts();
  std::size_t carrying = 0;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    carrying += contacts.carries(k, span_of(contacts, engine.particles(), k).opening);
  return static_cast<double>(carrying) / static_cast<double>(engine.size());
}

template <int dim>
Speeds time_in_turn(const Workload& workload, const DemOptions& options,
                    const dem::Engine<dim>& engine, const Peers<dim>* peers) {
  const int steps = steps_of(options, engine.size());
  const int peer_steps = std::max(20, steps / 4); // slower
  const auto speed = [&](double seconds) {
    return 1e-6 * static_cast<double>(engine.size()) / seconds;
  };
  Speeds speeds;
  for (int round = 0; round < options.rounds; ++round)
    for (const int threads : options.threads) {
      omp_set_num_threads(threads);
      speeds[threads]["kerf"].push_back(speed(seconds_per_step(engine, steps)));
      if (peers == nullptr)
        continue;
      for (const std::string& code : peers->codes()) {
        fmt::print(stderr, "{}: round {}, {} threads, {}…\n", workload.name, round + 1, threads,
                   code);
        speeds[threads][code].push_back(speed(peers->seconds_per_step(code, threads, peer_steps)));
      }
    }
  return speeds;
}

template <int dim>
void run(const Workload& workload, const DemOptions& options, nlohmann::json& figures) {
  omp_set_num_threads(omp_get_num_procs());
  const dem::Settings<dim> settings = settings_of<dim>(workload);
  const double memory_before = resident_memory();
  dem::Engine<dim> engine(settings);
  const double time_step = time_step_of(engine);
  engine.start(time_step);
  const double particles = static_cast<double>(engine.size());
  const double resident = (resident_memory() - memory_before) / particles;
  figures["memory_" + workload.name]["1"]["kerf"] = resident;

  fmt::print("\n{}: {} particles, {:.2f} contacts that carry and {:.2f} listed a particle; {:.0f} "
             "bytes a particle resident, {:.0f} by its own count\n",
             workload.name, engine.size(), contacts_per_particle(engine),
             static_cast<double>(engine.contacts().size()) / particles, resident,
             engine.memory() / particles);

  std::unique_ptr<Peers<dim>> peers;
  if (options.peers)
    peers = std::make_unique<Peers<dim>>(workload, settings, engine, time_step);
  print(workload.name, time_in_turn(workload, options, engine, peers.get()), figures);

  for (const int threads : options.threads) {
    omp_set_num_threads(threads);
    const double steps = renewal_in_steps(settings, time_step);
    fmt::print("{:<32} {:>7} a renewal of the contact list takes {:.1f} steps\n", workload.name,
               threads, steps);
    figures["renewal_" + workload.name][std::to_string(threads)]["kerf"] = steps;
  }
}

std::vector<Workload> chosen(const std::vector<std::string>& names) {
  std::vector<Workload> workloads(dem_workloads().begin(), dem_workloads().end());
  if (names.empty())
    return workloads;
  std::vector<Workload> some;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(workloads, name, &Workload::name);
    if (found == workloads.end())
      throw std::invalid_argument(fmt::format("there is no workload {}", name));
    some.push_back(*found);
  }
  return some;
}

} // namespace

nlohmann::json dem(const DemOptions& options) {
  const std::vector<Workload> workloads = chosen(options.workloads);
  fmt::print("{} rounds in turn. 10^6 particle-steps per second without renewal of the list, the "
             "median (least..most):\n{:<32} {:>7} {:<9} {:>8} {:>28}\n",
             options.rounds, "workload", "threads", "code", "speed", "kerf / code");
  nlohmann::json figures;
  for (const Workload& workload : workloads)
    workload.dim == 2 ? run<2>(workload, options, figures) : run<3>(workload, options, figures);
  return figures;
}

nlohmann::json dem_sweep(int rounds) {
  omp_set_num_threads(1);
  nlohmann::json figures;
  std::vector<double> costs; // of a particle-step, ns
  fmt::print("bonded, 3D, one thread, {} rounds\n{:>10} {:>24} {:>12}\n", rounds, "particles",
             "ns per particle-step", "contacts");
  for (const std::size_t particles :
       {5'000, 20'000, 50'000, 100'000, 200'000, 500'000, 1'000'000, 2'000'000}) {
    dem::Engine<3> engine(shaken_lattice(particles));
    engine.start(time_step_of(engine));
    const double size = static_cast<double>(engine.size());
    std::vector<double> times;
    for (int round = 0; round < rounds; ++round)
      times.push_back(1e9 / size *
                      seconds_per_step(engine, std::max(10, static_cast<int>(1e7 / size))));
    costs.push_back(median(times));
    fmt::print("{:>10} {:>24.1f} {:>12.2f}\n", engine.size(), costs.back(),
               static_cast<double>(engine.bonds()) / size);
    figures[fmt::format("sweep_{}", engine.size())]["1"]["kerf"] = 1e3 / costs.back();
  }
  const auto [least, most] = std::ranges::minmax(costs);
  fmt::print("most / least: {:.2f}\n", most / least);
  return figures;
}

} // namespace kerf::benchmarks
