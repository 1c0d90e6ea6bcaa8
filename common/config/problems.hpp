// Everything that is wrong with a case, told at once.
#pragma once

#include "common/config/document.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace kerf::config {

class Problems {
public:
  explicit Problems(const Document& document) : document_(document) {}

  /// @param key      where the fault is: its line, or that of the nearest table, is named
  /// @param problem  one sentence
  /// @param fix      one sentence: what to write instead
  void add(const std::string& key, const std::string& problem, const std::string& fix) {
    const Place place = document_.place_of(key);
    entries_.push_back({place.line, ConfigError::entry(place, problem, fix)});
  }

  bool empty() const { return entries_.empty(); }

  /// Gives up when there is a problem, with the first ten in the order of the file.
  void throw_if_any() {
    if (entries_.empty())
      return;
    constexpr std::size_t most = 10;
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.line < b.line; });
    std::string text;
    for (std::size_t k = 0; k < std::min(most, entries_.size()); ++k)
      text += (k == 0 ? "" : "\n") + entries_[k].text;
    if (entries_.size() > most)
      text += "\nand " + std::to_string(entries_.size() - most) + " more.";
    throw ConfigError(text);
  }

private:
  struct Entry {
    int line;
    std::string text;
  };
  const Document& document_;
  std::vector<Entry> entries_;
};

} // namespace kerf::config
