#include "tests/benchmarks/options.hpp"

#include "tests/benchmarks/fem_models.hpp"

namespace kerf::benchmarks {
namespace {

std::vector<std::string> names_of_workloads() {
  std::vector<std::string> names;
  for (const FemWorkload& workload : fem_workloads())
    names.push_back(workload.name);
  return names;
}

void add_engine_options(CLI::App* command, std::vector<int>& threads, int& steps) {
  command->add_option("--threads", threads, "Numbers of threads, as 1,2")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  command->add_option("--steps", steps, "In a timed block [by the size of the model]")
      ->check(CLI::PositiveNumber);
}

} // namespace

std::unique_ptr<CLI::App> parser_of(Options& options) {
  auto app = std::make_unique<CLI::App>(
      "Times kerf. Take timings alone: other work on the machine shows in them.");
  app->require_subcommand(1);
  const auto add_command = [&](const char* name, const char* description, int& rounds) {
    CLI::App* command = app->add_subcommand(name, description);
    command->callback([&options, name] { options.command = name; });
    command->add_option("--rounds", rounds, "Rounds; the median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--json", options.json_file, "Writes the figures to this file, too");
    return command;
  };

  CLI::App* exchange =
      add_command("exchange", "A coupled step besides its participants", options.exchange_rounds);
  exchange->add_option("--points", options.points, "Interface points")
      ->check(CLI::Range(1, 1000000));

  CLI::App* dem = add_command("dem", "Steps of the particle engine", options.dem.rounds);
  add_engine_options(dem, options.dem.threads, options.dem.steps);
  dem->add_option("--workloads", options.dem.workloads, "Names, as bonded_3d_50k [all]")
      ->delimiter(',');
  CLI::Option* dem_peers =
      dem->add_flag("--peers", options.dem.peers, "YADE, LAMMPS and LIGGGHTS, too");
  dem->add_flag("--sweep", options.sweep, "Instead: from 5000 to 2 000 000 particles")
      ->excludes(dem_peers);

  CLI::App* fem = add_command("fem", "Steps of the finite element engine", options.fem.rounds);
  add_engine_options(fem, options.fem.threads, options.fem.steps);
  fem->add_option("--workloads", options.fem.workloads, "Names, as hex8,tet4 [all]")
      ->delimiter(',')
      ->check(CLI::IsMember(names_of_workloads()));
  fem->add_option("--laws", options.fem.laws, "Names, as linear,j2 [all]")
      ->delimiter(',')
      ->check(CLI::IsMember(std::vector<std::string>(fem_laws.begin(), fem_laws.end())));
  CLI::Option* large = fem->add_flag("--large", options.fem.large, "Eight times as many elements");
  CLI::Option* fem_peers = fem->add_flag("--peers", options.fem.peers, "FEniCSx and deal.II, too");
  fem->add_flag("--sweep", options.sweep, "Instead: from 10 000 to 3 000 000 elements, one thread")
      ->excludes(large)
      ->excludes(fem_peers);
  return app;
}

} // namespace kerf::benchmarks
