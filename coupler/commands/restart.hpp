// Which checkpoint `kerf run --restart` goes on from, and whether it is one of this case.
#pragma once

#include "common/config/case_file.hpp"
#include "coupler/broker/broker.hpp"

#include <optional>
#include <string>

namespace kerf::commands {

/// What a checkpoint keeps to know its case and program again.
nlohmann::json identity(const CaseFile& case_file);

/// @param option  "DIR" or "DIR@STEP"; empty: nothing
/// @throws ConfigError when there is no such checkpoint, or when it is damaged, of another version
///         of kerf, or of another case; names the first keys that differ
std::optional<coupler::Restart> find_restart(const std::string& option, const CaseFile& case_file);

} // namespace kerf::commands
