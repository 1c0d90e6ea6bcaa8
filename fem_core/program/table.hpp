// Reads values out of a table of settings; an error knows its key.
#pragma once

#include "common/time_table.hpp"
#include "common/vec.hpp"
#include "coupler/participant/participant.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kerf::fem {

/// A table of settings as JSON, where null means not given.
///
/// Every function throws coupler::SettingsError, with the path of the value, when it is missing or
/// has another type.
class Table {
public:
  /// @param path  of the table: "", "mesh", "boundary[0]"
  Table(const nlohmann::json& value, std::string path);

  bool has(const std::string& key) const;
  bool is_text(const std::string& key, const std::string& text) const;
  std::string path(const std::string& key = "") const; // of the table itself, without a key
  Table table(const std::string& key) const;
  std::vector<Table> list(const std::string& key) const; // empty when it is not given

  double number(const std::string& key) const;
  double number(const std::string& key, double otherwise) const;
  bool flag(const std::string& key, bool otherwise) const;
  std::uint64_t count(const std::string& key) const;
  std::string text(const std::string& key) const;
  /// What a text stands for; `otherwise` when it is not given.
  template <class Value>
  Value one_of(const std::string& key, Value otherwise,
               const std::vector<std::pair<std::string, Value>>& choices) const {
    if (!has(key))
      return otherwise;
    std::string names;
    for (const auto& [name, value] : choices) {
      if (is_text(key, name))
        return value;
      names += (names.empty() ? "" : ", ") + name;
    }
    throw coupler::SettingsError(path(key),
                                 fmt::format("\"{}\" must be one of {}", text(key), names));
  }
  std::vector<std::string> texts(const std::string& key) const;
  std::vector<std::uint64_t> counts(const std::string& key, std::size_t size) const;
  std::vector<double> numbers(const std::string& key, std::size_t size) const;
  /// Rows of two numbers, as two columns.
  std::pair<std::vector<double>, std::vector<double>> columns(const std::string& key) const;

  /// A column of rows of a time and values, of which there are `size`.
  TimeTable time_table(const std::string& key, std::size_t column = 1, std::size_t size = 1) const;
  template <int dim> std::array<TimeTable, dim> time_tables(const std::string& key) const {
    std::array<TimeTable, dim> tables;
    for (std::size_t a = 0; a < dim; ++a)
      tables[a] = time_table(key, a + 1, dim);
    return tables;
  }

  template <int dim> Vec<dim> vector(const std::string& key) const {
    return to_vector<dim>(numbers(key, dim));
  }
  /// Lower and upper corner of a box.
  template <int dim> std::pair<Vec<dim>, Vec<dim>> corners(const std::string& key) const {
    const auto [lower, upper] = two_lists(key, dim);
    return {to_vector<dim>(lower), to_vector<dim>(upper)};
  }

private:
  template <int dim> static Vec<dim> to_vector(const std::vector<double>& values) {
    return Eigen::Map<const Vec<dim>>(values.data());
  }
  std::pair<std::vector<double>, std::vector<double>> two_lists(const std::string& key,
                                                                std::size_t size) const;
  template <class Value> Value get(const std::string& key, const char* what) const;

  const nlohmann::json& value_;
  std::string path_;
};

} // namespace kerf::fem
