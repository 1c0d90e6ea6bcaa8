#include "coupler/commands/measures.hpp"

#include "common/history.hpp"
#include "coupler/commands/region_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace kerf::commands {
namespace {

/// The histories of a run, summed over participants where a measure asks for a total.
class Histories {
public:
  Histories(const nlohmann::json& settings, const std::filesystem::path& run_folder) {
    const auto read = [&](const std::string& name) {
      return read_history(run_folder / "history" / (name + ".csv"));
    };
    for (const auto& [name, table] : settings.at("participants").items())
      participants_.emplace(name, read(name));
    for (const nlohmann::json& coupling : settings.at("couplings"))
      couplings_.emplace(coupling.at("name"), read(coupling.at("name")));
  }

  /// Sum of some columns, those that are there, over one participant or over all: [num_rows].
  std::vector<double> participants(const nlohmann::json& which,
                                   std::initializer_list<const char*> columns) const {
    return sum(participants_, which, columns);
  }
  std::vector<double> couplings(const nlohmann::json& which,
                                std::initializer_list<const char*> columns) const {
    return sum(couplings_, which, columns);
  }
  /// Largest last value of a column over one coupling or over all.
  double largest_of_couplings(const nlohmann::json& which, const char* column) const {
    double largest = 0.0;
    for (const auto& [name, table] : couplings_)
      if (which.is_null() || which == name)
        largest = std::max(largest, table.column(column).back());
    return largest;
  }

private:
  using Tables = std::map<std::string, HistoryTable>;

  static std::vector<double> sum(const Tables& tables, const nlohmann::json& which,
                                 std::initializer_list<const char*> columns) {
    std::vector<double> total;
    for (const auto& [name, table] : tables) {
      if (!which.is_null() && which != name)
        continue;
      if (total.empty())
        total.assign(table.rows.size(), 0.0);
      if (table.rows.size() != total.size())
        throw std::runtime_error("the histories of the run differ in length");
      for (const char* column : columns)
        if (table.has(column)) {
          const std::vector<double> values = table.column(column);
          for (std::size_t k = 0; k < total.size(); ++k)
            total[k] += values[k];
        }
    }
    return total;
  }

  Tables participants_, couplings_;
};

/// Energy of everything at each row; a single participant stands without the couplings.
std::vector<double> total_energy(const Histories& histories, const nlohmann::json& participant) {
  std::vector<double> energy =
      histories.participants(participant, {"kinetic_energy", "elastic_energy", "hourglass_energy"});
  if (participant.is_null()) {
    const std::vector<double> stored = histories.couplings({}, {"stored_energy"});
    for (std::size_t k = 0; k < stored.size(); ++k)
      energy[k] += stored[k];
  }
  return energy;
}

double energy_drift(const Histories& histories, const nlohmann::json& m) {
  const std::vector<double> E = total_energy(histories, m.at("participant"));
  return (E.back() - E.front()) / E.front();
}

/// max |E − E_0 − W + D| / max(E_0, |W|)
double energy_balance_error(const Histories& histories, const nlohmann::json& m) {
  const nlohmann::json& who = m.at("participant");
  const std::vector<double> E = total_energy(histories, who);
  std::vector<double> W = histories.participants(who, {"external_work"});
  if (!who.is_null()) {
    const std::vector<double> through = histories.participants(who, {"interface_work"});
    for (std::size_t k = 0; k < W.size(); ++k)
      W[k] += through[k];
  }
  const std::vector<double> D = histories.participants(
      who, {"damping_dissipation", "friction_dissipation", "fracture_dissipation",
            "plastic_dissipation"});
  double error = 0.0, scale = std::abs(E.front());
  for (std::size_t k = 0; k < E.size(); ++k) {
    error = std::max(error, std::abs(E[k] - E.front() - (W[k] - W.front()) + (D[k] - D.front())));
    scale = std::max(scale, std::abs(W[k]));
  }
  return error / scale;
}

/// Mean number of bonds of a particle at the start.
double coordination_number(const Histories& histories, const nlohmann::json& m) {
  const nlohmann::json& who = m.at("participant");
  return 2.0 * histories.participants(who, {"bonds", "broken_bonds"}).front() /
         histories.participants(who, {"particles"}).front();
}

/// What entered as a wave: all that the reference has at the end, or, without a reference, the
/// energy at the start and the work done by prescribed motion.
double incident_energy(const Histories& histories, const nlohmann::json& m) {
  const nlohmann::json& reference = m.at("reference");
  if (!reference.is_null())
    return total_energy(histories, reference).back();
  return total_energy(histories, nullptr).front() +
         histories.participants(nullptr, {"external_work"}).back();
}

} // namespace

std::vector<Measure> measure(const CaseFile& case_file, const std::filesystem::path& run_folder,
                             double wall_time) {
  const nlohmann::json& settings = case_file.settings();
  if (settings.at("measures").empty())
    return {}; // participants of the user's own need not write histories
  const Histories histories(settings, run_folder);
  const auto wave_energy = [&](const nlohmann::json& m) {
    return energy_in_region(run_folder, settings, m) / incident_energy(histories, m);
  };
  struct Kind {
    const char* unit;
    std::function<double(const nlohmann::json&)> value;
  };
  const std::map<std::string, Kind> kinds = {
      {"reflected_energy", {"1", wave_energy}},
      {"transmitted_energy", {"1", wave_energy}},
      {"energy_drift", {"1", [&](const nlohmann::json& m) { return energy_drift(histories, m); }}},
      {"energy_balance_error",
       {"1", [&](const nlohmann::json& m) { return energy_balance_error(histories, m); }}},
      {"momentum_residual",
       {"1",
        [&](const nlohmann::json& m) {
          return histories.largest_of_couplings(m.at("coupling"), "momentum_residual");
        }}},
      {"constraint_violation",
       {"m",
        [&](const nlohmann::json& m) {
          return histories.largest_of_couplings(m.at("coupling"), "constraint_violation");
        }}},
      {"coordination_number",
       {"1", [&](const nlohmann::json& m) { return coordination_number(histories, m); }}},
      {"wall_time", {"s", [&](const nlohmann::json&) { return wall_time; }}},
  };

  std::vector<Measure> measures;
  for (const nlohmann::json& m : settings.at("measures")) {
    const Kind& kind = kinds.at(m.at("kind"));
    Measure& taken = measures.emplace_back();
    taken.name = m.at("name");
    taken.unit = kind.unit;
    taken.value = kind.value(m);
    const nlohmann::json& expect = m.at("expect");
    if (!expect.is_null()) {
      if (!expect.at("min").is_null())
        taken.least = expect.at("min").get<double>();
      if (!expect.at("max").is_null())
        taken.most = expect.at("max").get<double>();
    }
  }
  return measures;
}

nlohmann::json summary(const std::vector<Measure>& measures) {
  nlohmann::json summary = nlohmann::json::object();
  for (const Measure& m : measures)
    summary[m.name] = {{"value", m.value}, {"unit", m.unit}};
  return summary;
}

} // namespace kerf::commands
