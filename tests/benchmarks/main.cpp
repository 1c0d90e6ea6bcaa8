// kerf bench - times the workloads of the performance page and prints ratios.
#include "tests/benchmarks/exchange.hpp"
#include "tests/benchmarks/machine.hpp"
#include "tests/benchmarks/options.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace {

using namespace kerf::benchmarks;

nlohmann::json figures_of(const Options& options) {
  if (options.command == "exchange")
    return exchange(options.points, options.exchange_rounds);
  const bool of_dem = options.command == "dem";
  nlohmann::json figures = machine(of_dem ? options.dem.threads : options.fem.threads);
  if (of_dem)
    figures.update(options.sweep ? dem_sweep(options.dem.rounds) : dem(options.dem));
  else
    figures.update(options.sweep ? fem_sweep(options.fem) : fem(options.fem));
  return figures;
}

} // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ); // rows appear when they are known, in a file, too
  Options options;
  const auto parser = parser_of(options);
  CLI11_PARSE(*parser, argc, argv);
  try {
    const nlohmann::json figures = figures_of(options);
    if (!options.json_file.empty())
      std::ofstream(options.json_file) << figures.dump(2) << "\n";
  } catch (const std::exception& error) {
    fmt::print(stderr, "kerf bench: {}.\n", error.what());
    return 1;
  }
  return 0;
}
