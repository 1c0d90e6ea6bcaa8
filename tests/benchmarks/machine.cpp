#include "tests/benchmarks/machine.hpp"

#include "common/instruction_set.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

namespace kerf {

namespace baseline {
int operations_per_turn();
double multiply_and_add(std::int64_t turns);
} // namespace baseline
namespace avx2 {
int operations_per_turn();
double multiply_and_add(std::int64_t turns);
} // namespace avx2
namespace avx512 {
int operations_per_turn();
double multiply_and_add(std::int64_t turns);
} // namespace avx512

namespace benchmarks {
namespace {

constexpr int repetitions = 5;

/// The shortest of several repetitions, s.
template <class Work> double shortest(Work work) {
  double least = std::numeric_limits<double>::infinity();
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const double start = omp_get_wtime();
    work();
    least = std::min(least, omp_get_wtime() - start);
  }
  return least;
}

} // namespace

double bandwidth(double bytes) {
  const auto count = static_cast<std::int64_t>(bytes / (3 * sizeof(double)));
  const auto passes = std::max<std::int64_t>(1, static_cast<std::int64_t>(200e6 / bytes));
  const auto array = [count] { return std::make_unique_for_overwrite<double[]>(count); };
  const auto a = array(), b = array(), c = array();
#pragma omp parallel for schedule(static)
  for (std::int64_t i = 0; i < count; ++i) {
    a[i] = 0.0;
    b[i] = 1.0;
    c[i] = static_cast<double>(i);
  }
  const double seconds = shortest([&] {
#pragma omp parallel
    for (std::int64_t pass = 0; pass < passes; ++pass)
#pragma omp for schedule(static)
      for (std::int64_t i = 0; i < count; ++i)
        a[i] = b[i] + 3.0 * c[i];
  });
  return 3.0 * sizeof(double) * static_cast<double>(count * passes) / seconds * 1e-9;
}

double multiply_adds() {
  const auto kernel =
      dispatch(baseline::multiply_and_add, avx2::multiply_and_add, avx512::multiply_and_add);
  const int operations = dispatch(baseline::operations_per_turn, avx2::operations_per_turn,
                                  avx512::operations_per_turn)();
  constexpr std::int64_t turns = 20'000'000;
  double sum = 0.0;
  const double seconds = shortest([&] {
#pragma omp parallel reduction(+ : sum)
    sum += kernel(turns);
  });
  const double all = static_cast<double>(turns) * operations * omp_get_max_threads();
  return sum > 0.0 ? all / seconds * 1e-9 : 0.0;
}

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      return line.substr(line.find(':') + 2);
  return "unknown processor";
}

double load() {
  double jobs = 0.0;
  std::ifstream("/proc/loadavg") >> jobs;
  return jobs;
}

} // namespace

nlohmann::json machine(std::span<const int> threads) {
  fmt::print("{}, {} cores, {:.1f} jobs in the last minute, instructions {}\n", processor(),
             omp_get_num_procs(), load(), name_of(instruction_set()));
  nlohmann::json figures;
  for (const int count : threads) {
    omp_set_num_threads(count);
    const double triad = bandwidth(600e6), rate = multiply_adds();
    fmt::print("threads {}: triad {:.1f} GB/s, multiply-add {:.1f} GFLOP/s\n", count, triad, rate);
    figures["triad"][std::to_string(count)]["limit"] = triad;
    figures["fma"][std::to_string(count)]["limit"] = rate;
  }
  return figures;
}

} // namespace benchmarks
} // namespace kerf
