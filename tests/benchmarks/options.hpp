// What kerf bench is told to do.
#pragma once

#include "tests/benchmarks/dem.hpp"
#include "tests/benchmarks/fem.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace kerf::benchmarks {

struct Options {
  std::string command; // exchange, dem or fem
  std::string json_file;
  int points = 1000, exchange_rounds = 7;
  DemOptions dem;
  FemOptions fem;
  bool sweep = false; // of dem or fem
};

/// A parser of the command line that fills `options`, which must outlive it.
std::unique_ptr<CLI::App> parser_of(Options& options);

} // namespace kerf::benchmarks
