// What the types of the table of keys mean for a value.
#pragma once

#include "common/config/schema.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace kerf::config {

/// @param dimension  of the case; 0: not known, then vectors of any length pass
bool has_type(const nlohmann::json& value, Type type, std::size_t dimension);

/// "an array of two texts": what has_type() wants.
std::string wanted(Type type, std::size_t dimension);

/// "a number": what a value is.
std::string type_of(const nlohmann::json& value);

/// A value for an error: TOML, cut when it is long.
std::string shown(const nlohmann::json& value);

/// Whether a text can be part of the name of a file: letters, digits, _ and -.
bool is_name(const std::string& text);

/// Calls visit for a value that is not an array, or for every such value inside.
void for_each_scalar(const nlohmann::json& value,
                     const std::function<void(const nlohmann::json&)>& visit);

/// The value with floating-point numbers, also where 1 was written for 1.0.
nlohmann::json as_reals(const nlohmann::json& value);

} // namespace kerf::config
