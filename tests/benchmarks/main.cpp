// kerf bench - times the workloads of the performance page and prints ratios.
#include "tests/benchmarks/exchange.hpp"

#include <CLI/CLI.hpp>

#include <fstream>

int main(int argc, char** argv) {
  CLI::App app{"Times kerf. Take timings alone: other work on the machine shows in them."};
  app.require_subcommand(1);
  std::string json_file;
  int points = 1000, rounds = 7;
  CLI::App* exchange = app.add_subcommand("exchange", "A coupled step besides its participants");
  exchange->add_option("--points", points, "Interface points")->check(CLI::Range(1, 1000000));
  exchange->add_option("--rounds", rounds, "Rounds; the median counts")->check(CLI::Range(1, 1000));
  exchange->add_option("--json", json_file, "Writes the figures to this file, too");
  CLI11_PARSE(app, argc, argv);

  const nlohmann::json figures = kerf::benchmarks::exchange(points, rounds);
  if (!json_file.empty())
    std::ofstream(json_file) << figures.dump(2) << "\n";
  return 0;
}
