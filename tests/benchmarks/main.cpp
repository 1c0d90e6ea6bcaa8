// kerf bench - times the workloads of the performance page and prints ratios.
#include "tests/benchmarks/dem.hpp"
#include "tests/benchmarks/exchange.hpp"
#include "tests/benchmarks/machine.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace {

using namespace kerf::benchmarks;

nlohmann::json machine_and_dem(const DemOptions& options, bool sweep) {
  nlohmann::json figures = machine(options.threads);
  figures.update(sweep ? dem_sweep(options.rounds) : dem(options));
  return figures;
}

} // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ); // rows appear when they are known, in a file, too
  CLI::App app{"Times kerf. Take timings alone: other work on the machine shows in them."};
  app.require_subcommand(1);
  std::string json_file;
  const auto add_common_options = [&](CLI::App* command, int& rounds) {
    command->add_option("--rounds", rounds, "Rounds; the median counts")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    command->add_option("--json", json_file, "Writes the figures to this file, too");
  };

  int points = 1000, exchange_rounds = 7;
  CLI::App* exchange_command =
      app.add_subcommand("exchange", "A coupled step besides its participants");
  exchange_command->add_option("--points", points, "Interface points")
      ->check(CLI::Range(1, 1000000));
  add_common_options(exchange_command, exchange_rounds);

  DemOptions options;
  bool sweep = false;
  CLI::App* dem_command = app.add_subcommand("dem", "Steps of the particle engine");
  add_common_options(dem_command, options.rounds);
  dem_command->add_option("--threads", options.threads, "Numbers of threads, as 1,2")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  dem_command->add_option("--workloads", options.workloads, "Names, as bonded_3d_50k [all]")
      ->delimiter(',');
  dem_command->add_option("--steps", options.steps, "In a timed block [by the size of the model]")
      ->check(CLI::PositiveNumber);
  CLI::Option* peers =
      dem_command->add_flag("--peers", options.peers, "YADE, LAMMPS and LIGGGHTS, too");
  dem_command->add_flag("--sweep", sweep, "Instead: from 5000 to 2 000 000 particles")
      ->excludes(peers);
  CLI11_PARSE(app, argc, argv);

  try {
    const nlohmann::json figures = exchange_command->parsed() ? exchange(points, exchange_rounds)
                                                              : machine_and_dem(options, sweep);
    if (!json_file.empty())
      std::ofstream(json_file) << figures.dump(2) << "\n";
  } catch (const std::exception& error) {
    fmt::print(stderr, "kerf bench: {}.\n", error.what());
    return 1;
  }
  return 0;
}
