// The error of a case file that cannot be used, and where in the file the fault is.
#pragma once

#include <stdexcept>
#include <string>

namespace kerf {

/// Where a value of the case comes from: a line of the file, or an override of the command line.
struct Place {
  std::string source; // path of the file as the user gave it, or "--set key=value"
  int line = 0;       // from 1; 0: none

  /// "configs/wave_bar.toml:31", or the source alone.
  std::string text() const { return line > 0 ? source + ":" + std::to_string(line) : source; }
};

/// A case file cannot be used. what() is made of entries of two lines, one for each problem found:
///
///     configs/wave_bar.toml:31: participants.rock.damping.translation = 1.4 must be from 0 to 1.
///       Fix: give the share of the resultant force that opposes the motion, for example 0.2.
class ConfigError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;

  /// @param problem  one sentence with the key, the value found and what is allowed
  /// @param fix      one sentence: what to write instead, without "Fix:"
  ConfigError(const Place& place, const std::string& problem, const std::string& fix)
      : std::runtime_error(entry(place, problem, fix)) {}

  static std::string entry(const Place& place, const std::string& problem, const std::string& fix) {
    return place.text() + ": " + problem + "\n  Fix: " + fix;
  }
};

} // namespace kerf
