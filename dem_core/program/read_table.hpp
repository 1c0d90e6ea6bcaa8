// Tables of times as a case gives them.
#pragma once

#include "dem_core/program/settings_node.hpp"
#include "common/time_table.hpp"

#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

namespace kerf::dem {

/// One column of the values; column 0 is the time.
inline TimeTable read_table(const Node& rows, std::size_t column) {
  std::vector<double> times, values;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    times.push_back(rows[k][0].number());
    values.push_back(rows[k][column].number());
  }
  try {
    return TimeTable(std::move(times), std::move(values));
  } catch (const std::invalid_argument& error) {
    rows.fail(error.what(), "give rows of a time and its values, the times ascending");
  }
}

template <int dim> std::array<TimeTable, dim> read_vector_table(const Node& rows) {
  std::array<TimeTable, dim> tables;
  for (std::size_t a = 0; a < dim; ++a)
    tables[a] = read_table(rows, a + 1);
  return tables;
}

/// One value, or a table of times; zero when neither is given.
inline TimeTable read_value_or_table(const Node& value, const Node& rows) {
  return rows.is_null() ? TimeTable(value.number_or(0.0)) : read_table(rows, 1);
}

} // namespace kerf::dem
