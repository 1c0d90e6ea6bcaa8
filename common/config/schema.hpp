// The one table of everything that a case file may say. Checking, defaults, the file written with a
// run and configs/reference.toml all come from it; a new key is one more line in schema.cpp.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::config {

enum class Type {
  table,          // of fixed keys; when it is not given its keys take their defaults
  optional_table, // null when it is not given
  named_tables,   // of any names, each a table of the keys under ".*"
  list,           // of tables of the keys under "[]"; empty when it is not given
  text,
  name, // text that may be part of a file name
  path, // of a file that exists; relative to the folder of the case
  flag,
  integer,
  number,
  integer_or_auto,
  number_or_auto,
  texts,           // [text…]
  numbers,         // [number…]
  pair,            // [text, text]
  interval,        // [number, number], the first below the second
  vector,          // [number…], one per dimension of the case
  counts,          // [integer…], one per dimension of the case
  box,             // [vector, vector], the lower and the upper corner
  curve,           // [[number, number]…], the first of them ascend
  numbers_of_time, // [[time, number]…], the times ascend
  vectors_of_time  // [[time, number per dimension…]…], the times ascend
};

/// Numbers that are allowed; of arrays, each of their numbers.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool without_least = false;
  bool without_most = false;

  bool has(double value) const;
  /// "from 0 to 1", "greater than 0"; empty when every number is.
  std::string text() const;
};

/// What is allowed beyond the type.
struct Allowed {
  Range range;
  std::vector<std::string> choices; // of text, or of integers

  /// "from 0 to 1", "lagrange or penalty"; empty when everything is.
  std::string text() const;
};

/// One key. `path` is its pattern: "participants.*.material.density", "couplings[].name".
struct Key {
  std::string path;
  std::string kind; // "dem", "fem": only of participants of that kind; empty: of any
  Type type;
  std::string unit;     // "kg/m³"; empty: none
  std::string standard; // the default as JSON; "null": not given; empty: required
  Allowed allowed;
  std::string example; // TOML, with quotes; of tables: what an error calls them
  std::string doc;     // completes "give …"
  bool live = false;   // given in the reference file although it has no default

  bool required() const { return standard.empty(); }
  bool is_table() const { return type <= Type::list; }
  std::string last() const; // "density"
};

/// Every key; a table stands before its own keys.
const std::vector<Key>& schema();

/// The keys directly inside a table.
/// @param table  pattern: "", "case", "participants.*", "couplings[]"
/// @param kind   of the participant that it belongs to; empty where it is of the whole case
std::vector<const Key*> keys_of(std::string_view table, std::string_view kind);

/// The pattern of the tables that a table-like key holds: "couplings[]", "participants.*", "case".
std::string inside(const Key& key);

} // namespace kerf::config
