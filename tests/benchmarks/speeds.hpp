// Speeds of codes on one workload, and how they are told.
#pragma once

#include "tests/benchmarks/statistics.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace kerf::benchmarks {

/// 1e6 particle- or element-steps/s of every round, by threads and code; kerf is always there.
using Speeds = std::map<int, std::map<std::string, std::vector<double>>>;

/// Prints the rows of a workload and adds {workload: {threads: {code: median}}} to the figures.
inline void print(const std::string& workload, const Speeds& speeds, nlohmann::json& figures) {
  for (const auto& [threads, codes] : speeds)
    for (const auto& [code, values] : codes) {
      const auto [least, most] = std::ranges::minmax(values);
      fmt::print("{:<32} {:>7} {:<9} {:>8.2f} ({:.2f}..{:.2f}) {:>12.2f}\n", workload, threads,
                 code, median(values), least, most, median(codes.at("kerf")) / median(values));
      figures[workload][std::to_string(threads)][code] = median(values);
    }
}

} // namespace kerf::benchmarks
