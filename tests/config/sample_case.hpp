// A case that is right in every way, for tests that break it in one.
#pragma once

#include "common/config/case_file.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace kerf {

inline const std::string sample = R"([case]
name = "sample"
dimension = 2
end_time = 1e-4

[participants.rock]
kind = "dem"

[participants.rock.particles.lattice]
type = "square"
spacing = 1e-3
origin = [0.0, 0.0]
count = [10, 4]

[participants.rock.material]
density = 2600.0
normal_stiffness = 1e10
tangential_stiffness = 2e9

[participants.rock.damping]
translation = 0.2

[participants.far]
kind = "fem"

[participants.far.mesh]
origin = [0.005, 0.0]
size = [0.02, 0.003]
count = [20, 3]

[participants.far.material]
density = 2358.0
young_modulus = 1.2e10
poisson_ratio = 0.2

[[participants.far.boundary]]
tag = "right"
motion = "fixed"

[[couplings]]
name = "joint"
between = ["rock", "far"]
boundary = "left"
width = 4e-3

[[measures]]
name = "energy_drift"
expect = { max = 1e-6 }
)";

inline CaseFile parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return CaseFile::parse(text, "case.toml", ".", overrides);
}

/// What the reader says of a case; empty when it takes it.
inline std::string complaint(const std::string& text,
                             const std::vector<std::string>& overrides = {}) {
  try {
    parse(text, overrides);
    return "";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

/// The sample with one text replaced.
inline std::string sample_with(const std::string& old_text, const std::string& new_text) {
  const std::size_t at = sample.find(old_text);
  if (at == std::string::npos)
    throw std::invalid_argument("the sample has no " + old_text);
  return std::string(sample).replace(at, old_text.size(), new_text);
}

/// "case.toml:7: " of the last line of the text that has the words.
inline std::string line_of(const std::string& text, const std::string& words) {
  const std::size_t at = text.rfind(words);
  if (at == std::string::npos)
    throw std::invalid_argument("the text has no " + words);
  int line = 1;
  for (std::size_t k = 0; k < at; ++k)
    line += text[k] == '\n';
  return "case.toml:" + std::to_string(line) + ": ";
}

} // namespace kerf
