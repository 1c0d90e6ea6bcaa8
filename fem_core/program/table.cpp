#include "fem_core/program/table.hpp"

namespace kerf::fem {

using coupler::SettingsError;

Table::Table(const nlohmann::json& value, std::string path)
    : value_(value), path_(std::move(path)) {
  if (!value_.is_object())
    throw SettingsError(path_, "it must be a table");
}

bool Table::has(const std::string& key) const {
  const auto found = value_.find(key);
  return found != value_.end() && !found->is_null();
}

bool Table::is_text(const std::string& key, const std::string& text) const {
  const auto found = value_.find(key);
  return found != value_.end() && found->is_string() && found->get<std::string>() == text;
}

std::string Table::path(const std::string& key) const {
  return path_.empty() || key.empty() ? path_ + key : path_ + "." + key;
}

template <class Value> Value Table::get(const std::string& key, const char* what) const {
  if (!has(key))
    throw SettingsError(path(key), fmt::format("it is missing; give {}", what));
  try {
    return value_.at(key).get<Value>();
  } catch (const nlohmann::json::exception&) {
    throw SettingsError(path(key),
                        fmt::format("it is {}; it must be {}", value_.at(key).dump(), what));
  }
}

Table Table::table(const std::string& key) const {
  if (!has(key))
    throw SettingsError(path(key), "it is missing; give a table");
  return Table(value_.at(key), path(key));
}

std::vector<Table> Table::list(const std::string& key) const {
  std::vector<Table> tables;
  if (!has(key))
    return tables;
  const nlohmann::json& values = value_.at(key);
  if (!values.is_array())
    throw SettingsError(path(key), "it must be a list of tables");
  for (std::size_t k = 0; k < values.size(); ++k)
    tables.emplace_back(values[k], fmt::format("{}[{}]", path(key), k));
  return tables;
}

double Table::number(const std::string& key) const {
  return get<double>(key, "a number");
}

double Table::number(const std::string& key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

bool Table::flag(const std::string& key, bool otherwise) const {
  return has(key) ? get<bool>(key, "true or false") : otherwise;
}

std::uint64_t Table::count(const std::string& key) const {
  const auto value = get<std::int64_t>(key, "a positive integer");
  if (value <= 0)
    throw SettingsError(path(key), fmt::format("it is {}; it must be a positive integer", value));
  return static_cast<std::uint64_t>(value);
}

std::string Table::text(const std::string& key) const {
  return get<std::string>(key, "a text");
}

std::vector<std::string> Table::texts(const std::string& key) const {
  return get<std::vector<std::string>>(key, "a list of texts");
}

std::vector<double> Table::numbers(const std::string& key, std::size_t size) const {
  auto values = get<std::vector<double>>(key, "a list of numbers");
  if (values.size() != size)
    throw SettingsError(path(key),
                        fmt::format("it has {} numbers; it must have {}", values.size(), size));
  return values;
}

std::pair<std::vector<double>, std::vector<double>> Table::columns(const std::string& key) const {
  std::pair<std::vector<double>, std::vector<double>> result;
  for (const auto& row : get<std::vector<std::vector<double>>>(key, "rows of two numbers")) {
    if (row.size() != 2)
      throw SettingsError(path(key),
                          fmt::format("a row has {} numbers; it must have 2", row.size()));
    result.first.push_back(row[0]);
    result.second.push_back(row[1]);
  }
  return result;
}

TimeTable Table::time_table(const std::string& key, std::size_t column, std::size_t size) const {
  std::vector<double> times, values;
  for (const auto& row : get<std::vector<std::vector<double>>>(key, "rows of a time and values")) {
    if (row.size() != size + 1)
      throw SettingsError(path(key), fmt::format("a row has {} numbers; it must have a time and {}",
                                                 row.size(), size));
    times.push_back(row[0]);
    values.push_back(row[column]);
  }
  try {
    return TimeTable(std::move(times), std::move(values));
  } catch (const std::invalid_argument& error) {
    throw SettingsError(path(key), error.what());
  }
}

std::vector<std::uint64_t> Table::counts(const std::string& key, std::size_t size) const {
  const auto values = get<std::vector<std::int64_t>>(key, "a list of integers");
  if (values.size() != size)
    throw SettingsError(path(key),
                        fmt::format("it has {} integers; it must have {}", values.size(), size));
  for (const std::int64_t value : values)
    if (value <= 0)
      throw SettingsError(path(key), fmt::format("{} must be a positive integer", value));
  return {values.begin(), values.end()};
}

std::pair<std::vector<double>, std::vector<double>> Table::two_lists(const std::string& key,
                                                                     std::size_t size) const {
  auto lists = get<std::vector<std::vector<double>>>(key, "a lower and an upper corner");
  if (lists.size() != 2 || lists[0].size() != size || lists[1].size() != size)
    throw SettingsError(
        path(key), fmt::format("it must be a lower and an upper corner of {} numbers each", size));
  return {std::move(lists[0]), std::move(lists[1])};
}

} // namespace kerf::fem
