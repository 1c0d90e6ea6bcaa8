// What a test verifies: stated and checked in one place, and reported for docs/verification.md.
#pragma once

#include <source_location>
#include <string>

namespace kerf {

/// An answer that kerf must find. The texts become a row of the table, so they name no machine and
/// have no `|`.
struct Verification {
  std::string what;       // is verified
  std::string source;     // of the answer: equation, DOI, independent code
  double tolerance = 0.0; // of the error; the same unit
  std::string reason;     // of the tolerance
};

/// Expects |error| <= tolerance. Where the environment variable KERF_VERIFICATION names a folder,
/// the test writes a file of what it verified there; of several errors of one claim the table has
/// the largest.
void verify(const Verification& claim, double error,
            std::source_location where = std::source_location::current());

} // namespace kerf
