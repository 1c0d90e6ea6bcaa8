// Rules that many tables share: keys that need or exclude one another.
#pragma once

#include "common/config/problems.hpp"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace kerf::config {

class KeyChecks {
protected:
  KeyChecks(const nlohmann::json& settings, Problems& problems)
      : problems_(problems), is_plane_(settings["case"]["dimension"] == 2) {}

  /// Those that are given, in this order.
  static std::vector<std::string> given(const nlohmann::json& table,
                                        const std::vector<std::string>& names);
  /// Two ways to give one quantity.
  void check_one_of(const std::string& key, const nlohmann::json& table, const std::string& first,
                    const std::string& second);
  /// Each choice of a key needs its own keys and none of the others'.
  void check_keys_of(const std::string& key, const nlohmann::json& table,
                     const std::string& choice_key, const std::string& choice,
                     const std::map<std::string, std::set<std::string>>& keys);
  void check_components(const std::string& key, const nlohmann::json& components);
  void check_rotation(const std::string& key, const nlohmann::json& tool);
  /// A prescribed motion, of particles or of nodes.
  void check_boundary(const std::string& key, const nlohmann::json& boundary);
  /// Nodes by a tag or by a box.
  void check_place(const std::string& key, const nlohmann::json& table);
  /// A stress at the start, uniform or growing with depth.
  /// @param order    of the components of a uniform one: "xx yy xy"
  /// @param gravity  of the participant
  void check_stress(const std::string& key, const nlohmann::json& stress, const std::string& order,
                    const nlohmann::json& gravity);
  void check_name(const std::string& key, const std::string& name, const std::string& list,
                  std::set<std::string>& names);

  Problems& problems_;
  bool is_plane_;
};

} // namespace kerf::config
