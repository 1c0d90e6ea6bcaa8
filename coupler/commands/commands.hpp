// The verbs of the program kerf. Each returns the exit code of the process.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kerf::commands {

struct RunOptions {
  std::filesystem::path case_file;
  std::filesystem::path out;          // empty: results/<case>
  std::vector<std::string> overrides; // key=value
  std::string transport;              // empty: what the case says
  std::string restart;                // folder[@step] of a checkpoint; empty: from the start
};

/// Launches every participant, brokers the run, writes the results, prints the measures.
int run(const RunOptions& options);

/// Does all of a run but its steps, and prints the plan.
int check(const RunOptions& options);

/// Becomes the program `kerf-dem pack`; returns only when that cannot be started.
int pack(const std::vector<std::string>& arguments);

} // namespace kerf::commands
