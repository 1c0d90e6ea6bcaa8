// The measures that a case names, taken from the files of a finished run.
#pragma once

#include "common/config/case_file.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kerf::commands {

struct Measure {
  std::string name;
  std::string unit;
  double value = 0.0;
  std::optional<double> least, most; // expectation of the case

  bool met() const {
    // Written so that a value that is not a number meets nothing.
    return (!least || value >= *least) && (!most || value <= *most);
  }
};

/// @param wall_time  of the whole run, s
/// @throws std::runtime_error when a result is missing, std::invalid_argument when a measure
///         cannot be taken from these participants
std::vector<Measure> measure(const CaseFile& case_file, const std::filesystem::path& run_folder,
                             double wall_time);

/// What summary.json keeps: name -> value and unit.
nlohmann::json summary(const std::vector<Measure>& measures);

} // namespace kerf::commands
