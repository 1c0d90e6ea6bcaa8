#include "common/config/value_types.hpp"

#include "common/config/document.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kerf::config {

using nlohmann::json;
using std::string;

namespace {

bool is_array_of(const json& value, std::size_t size, const std::function<bool(const json&)>& is) {
  return value.is_array() && (size == 0 ? !value.empty() : value.size() == size) &&
         std::all_of(value.begin(), value.end(), is);
}

/// @param columns  beside the first, which ascends; 0: any number of them, in every row the same
bool is_ascending_table(const json& value, std::size_t columns) {
  const auto is_number = [](const json& v) { return v.is_number(); };
  if (!is_array_of(value, 0, [](const json& row) { return row.is_array() && row.size() > 1; }))
    return false;
  const std::size_t size = columns == 0 ? value[0].size() : columns + 1;
  for (std::size_t k = 0; k < value.size(); ++k)
    if (!is_array_of(value[k], size, is_number) || (k > 0 && value[k][0] <= value[k - 1][0]))
      return false;
  return true;
}

} // namespace

string shown(const json& value) {
  const string text = value_text(value);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

string type_of(const json& value) {
  if (value.is_string())
    return "text";
  if (value.is_boolean())
    return "a boolean";
  if (value.is_number_integer())
    return "an integer";
  if (value.is_number())
    return "a number";
  return value.is_array() ? fmt::format("an array of {}", value.size()) : "a table";
}

bool is_name(const string& text) {
  const string letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !text.empty() && text.front() != '-' && text.size() <= 64 &&
         text.find_first_not_of(letters) == string::npos;
}

string wanted(Type type, std::size_t dimension) {
  const string how_many = dimension == 0 ? "" : fmt::format("{} ", dimension);
  switch (type) {
  case Type::table:
  case Type::optional_table:
  case Type::named_tables:
    return "a table";
  case Type::list:
    return "a list of tables, each begun with [[...]]";
  case Type::text:
  case Type::name:
  case Type::path:
    return "text in quotes";
  case Type::flag:
    return "true or false";
  case Type::integer:
    return "an integer";
  case Type::number:
    return "a number";
  case Type::integer_or_auto:
    return "an integer or \"auto\"";
  case Type::number_or_auto:
    return "a number or \"auto\"";
  case Type::texts:
    return "an array of texts";
  case Type::numbers:
    return "an array of numbers";
  case Type::pair:
    return "an array of two texts";
  case Type::interval:
    return "an array of two numbers, the smaller one first";
  case Type::vector:
    return fmt::format("an array of {}numbers, one for each dimension", how_many);
  case Type::counts:
    return fmt::format("an array of {}integers, one for each dimension", how_many);
  case Type::box:
    return fmt::format("two corners of {}numbers each, the lower one first", how_many);
  case Type::curve:
    return "rows of two numbers, the first ascending";
  case Type::numbers_of_time:
    return "rows of a time and a number, the times ascending";
  case Type::vectors_of_time:
    return fmt::format("rows of a time and {}numbers, the times ascending", how_many);
  }
  return "";
}

bool has_type(const json& value, Type type, std::size_t dimension) {
  const auto is_text = [](const json& v) { return v.is_string(); };
  const auto is_number = [](const json& v) { return v.is_number(); };
  const auto is_integer = [](const json& v) { return v.is_number_integer(); };
  const auto is_vector = [&](const json& v) { return is_array_of(v, dimension, is_number); };
  switch (type) {
  case Type::table:
  case Type::optional_table:
  case Type::named_tables:
    return value.is_object();
  case Type::list:
    return is_array_of(value, value.size(), [](const json& v) { return v.is_object(); });
  case Type::text:
  case Type::name:
  case Type::path:
    return value.is_string();
  case Type::flag:
    return value.is_boolean();
  case Type::integer:
    return value.is_number_integer();
  case Type::number:
    return value.is_number();
  case Type::integer_or_auto:
    return value.is_number_integer() || value == "auto";
  case Type::number_or_auto:
    return value.is_number() || value == "auto";
  case Type::texts:
    return is_array_of(value, 0, is_text);
  case Type::numbers:
    return is_array_of(value, 0, is_number);
  case Type::pair:
    return is_array_of(value, 2, is_text);
  case Type::interval:
    return is_array_of(value, 2, is_number) && value[0] < value[1];
  case Type::vector:
    return is_vector(value);
  case Type::counts:
    return is_array_of(value, dimension, is_integer);
  case Type::box:
    if (!is_array_of(value, 2, is_vector) || value[0].size() != value[1].size())
      return false;
    for (std::size_t axis = 0; axis < value[0].size(); ++axis)
      if (value[0][axis] > value[1][axis])
        return false;
    return true;
  case Type::curve:
  case Type::numbers_of_time:
    return is_ascending_table(value, 1);
  case Type::vectors_of_time:
    return is_ascending_table(value, dimension);
  }
  return false;
}

void for_each_scalar(const json& value, const std::function<void(const json&)>& visit) {
  if (!value.is_array())
    return visit(value);
  for (const json& member : value)
    for_each_scalar(member, visit);
}

json as_reals(const json& value) {
  if (!value.is_array())
    return value.is_number() ? json(value.get<double>()) : value;
  json reals = json::array();
  for (const json& member : value)
    reals.push_back(as_reals(member));
  return reals;
}

} // namespace kerf::config
