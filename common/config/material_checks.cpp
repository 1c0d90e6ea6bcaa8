// What can be wrong with several materials beyond the types of their values.
#include "common/config/case_reader.hpp"
#include "common/config/value_types.hpp"
#include "common/nearest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

namespace kerf::config {
namespace {

using nlohmann::json;
using std::string;

class MaterialChecks {
public:
  MaterialChecks(const string& participant, const json& table, Problems& problems)
      : participant_(participant), table_(table), problems_(problems) {}

  void run() {
    add_material(participant_ + ".material", table_["material"]);
    for (std::size_t k = 0; k < table_["materials"].size(); ++k) {
      const string key = fmt::format("{}.materials[{}]", participant_, k);
      add_material(key, table_["materials"][k]);
      check_selection(key, table_["materials"][k]);
    }
    for (std::size_t k = 0; k < table_["pairs"].size(); ++k)
      check_pair(fmt::format("{}.pairs[{}]", participant_, k), table_["pairs"][k]);
    check_laws();
  }

private:
  void add_material(const string& key, const json& material) {
    const string name = material["name"];
    if (std::find(names_.begin(), names_.end(), name) != names_.end())
      problems_.add(key + ".name",
                    fmt::format("two materials of {} are named \"{}\".", participant_, name),
                    "give each one a name of its own.");
    names_.push_back(name);
    is_hertzian_.push_back(material["law"] == "hertz_mindlin");
    check_together(key, material, material["law"]);
  }

  /// Constants that are of no use alone; those of the own law are checked with it.
  void check_together(const string& key, const json& table, const json& law) {
    const std::pair<string, std::pair<string, string>> groups[] = {
        {"linear", {"normal_stiffness", "tangential_stiffness"}},
        {"linear_by_size", {"contact_modulus", "stiffness_ratio"}},
        {"hertz_mindlin", {"young_modulus", "poisson_ratio"}}};
    for (const auto& [of_law, names] : groups) {
      const auto& [first, second] = names;
      if (law != of_law && table[first].is_null() != table[second].is_null())
        problems_.add(key, fmt::format("{} has only one of {} and {}.", key, first, second),
                      "give both.");
    }
    if (!table["normal_stiffness"].is_null() && !table["contact_modulus"].is_null() &&
        (law.is_null() || law == "hertz_mindlin"))
      problems_.add(key + ".contact_modulus",
                    key + " has both normal_stiffness and contact_modulus.", "give one of them.");
  }

  void check_selection(const string& key, const json& material) {
    std::vector<string> found;
    for (const char* name : {"box", "ids", "file"})
      if (!material[name].is_null())
        found.emplace_back(name);
    if (found.size() != 1)
      problems_.add(key,
                    fmt::format("{} has {}.", key,
                                found.empty() ? "neither box nor ids nor file"
                                              : fmt::format("{}", fmt::join(found, " and "))),
                    "give one of them: it says which particles are of it.");
    if (material["file"].is_null() != material["number"].is_null())
      problems_.add(key + ".number",
                    fmt::format("{}.number is {}.", key,
                                material["number"].is_null() ? "missing" : "given without a file"),
                    "give it with a file: the number in the lines of its particles.");
  }

  void check_pair(const string& key, const json& pair) {
    check_together(key, pair, json());
    std::vector<std::size_t> indices;
    for (const string name : pair["between"]) {
      const auto found = std::find(names_.begin(), names_.end(), name);
      if (found == names_.end()) {
        const string meant = nearest(name, names_);
        problems_.add(key + ".between",
                      fmt::format("{}.between names \"{}\", which is not a material of {}.", key,
                                  name, participant_),
                      meant.empty() ? fmt::format("name two of {}.", fmt::join(names_, ", "))
                                    : "did you mean " + meant + "?");
        return;
      }
      indices.push_back(static_cast<std::size_t>(found - names_.begin()));
    }
    const auto both = std::minmax(indices[0], indices[1]);
    if (!pairs_.insert(both).second)
      problems_.add(key + ".between",
                    fmt::format("{}.between = {} is given twice.", key, shown(pair["between"])),
                    "give one table for each pair.");
    if (pair["law"].is_null() && is_hertzian_[both.first] != is_hertzian_[both.second])
      problems_.add(key + ".law", key + ".law is missing.",
                    "its materials have different laws: say which counts between them.");
  }

  void check_laws() {
    for (std::size_t b = 0; b < names_.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        if (is_hertzian_[a] != is_hertzian_[b] && !pairs_.contains({a, b}))
          problems_.add(
              participant_ + ".pairs",
              fmt::format("the materials \"{}\" and \"{}\" of {} have different laws.", names_[a],
                          names_[b], participant_),
              fmt::format("give a table [[{}.pairs]] with between = [\"{}\", \"{}\"] and the law "
                          "that counts between them.",
                          participant_, names_[a], names_[b]));
  }

  const string& participant_;
  const json& table_;
  Problems& problems_;
  std::vector<string> names_;
  std::vector<bool> is_hertzian_;
  std::set<std::pair<std::size_t, std::size_t>> pairs_;
};

} // namespace

void check_materials(const string& participant, const json& table, Problems& problems) {
  MaterialChecks(participant, table, problems).run();
}

} // namespace kerf::config
