// A TOML text as plain values, each with the place where it stands.
#pragma once

#include "common/config/config_error.hpp"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <string_view>

namespace kerf::config {

/// Tables are objects, arrays are arrays, dates are text.
struct Document {
  std::string source; // names the file in errors
  nlohmann::json values = nlohmann::json::object();
  std::map<std::string, Place, std::less<>> places; // by key; members of arrays by index

  /// Where a key stands, or else the nearest table around it.
  Place place_of(std::string_view key) const;
};

/// @throws ConfigError for what is not TOML, and for what is defined twice
Document parse_document(std::string_view text, const std::string& source);

/// Sets one value as "key=value" says. The value is TOML, or else text; tables on the way are made.
/// @throws ConfigError when it is not of that form, or goes through something that is not a table
void apply_override(Document& document, const std::string& assignment);

/// The key with every member of a list by index: "couplings.joint.width" is "couplings[0].width".
/// What the values do not have is kept as it is.
std::string canonical_key(const nlohmann::json& values, std::string_view key);

/// One TOML value.
/// @throws ConfigError when it is none
nlohmann::json parse_value(std::string_view text);

/// A value as TOML on one line; numbers are the shortest that read back to the same bits.
std::string value_text(const nlohmann::json& value);

} // namespace kerf::config
