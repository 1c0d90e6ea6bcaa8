#include "dem_core/program/dem_participant.hpp"

#include "common/checkpoint.hpp"
#include "common/stopwatch.hpp"
#include "coupler/participant/run_engine.hpp"
#include "dem_core/engine.hpp"
#include "dem_core/program/dem_output.hpp"
#include "dem_core/program/read_settings.hpp"
#include "dem_core/program/stages.hpp"
#include "dem_core/spatial_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <omp.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <optional>
#include <stdexcept>

namespace kerf::dem {

namespace {

using coupler::SettingsError;
using nlohmann::json;

/// Measures the two calls in which an engine works (without a coupling all is in the second), has
/// the cracks written as they happen, and
/// watches the critical step, which falls as contacts form.
template <int dim> class RecordedEngine {
public:
  /// @param is_coupled  somebody asks for the own forces before the step is made
  /// @param time_step   that must stay below the critical one, s; nothing: no matter
  RecordedEngine(Engine<dim>& engine, DemOutput<dim>& output, Stages<dim>& stages, bool is_coupled,
                 std::optional<double> time_step)
      : engine_(engine), output_(output), stages_(stages), is_coupled_(is_coupled),
        time_step_(time_step) {}

  void begin_stage(std::size_t stage) {
    if (stages_.size() == 0)
      return;
    stages_.begin(stage);
    output_.set_stage(stage);
  }
  /// The condition that the step which has just been integrated meets.
  std::optional<Met> met(std::size_t stage, std::uint64_t begin) const {
    return stages_.met(stage, begin);
  }

  void motion(std::span<const std::uint32_t> points, std::span<double> position,
              std::span<double> velocity) const {
    engine_.motion(points, position, velocity);
  }
  void compute_own_forces() {
    const bool checks = time_step_ && is_due_for_check();
    if (!is_coupled_ && !checks) // integrate() does it faster
      return;
    {
      const Stopwatch stopwatch(force_seconds);
      engine_.compute_own_forces();
      if (checks)
        check_step();
    }
    output_.write_cracks();
  }
  void own_forces(std::span<const std::uint32_t> points, std::span<double> force) const {
    engine_.own_forces(points, force);
  }
  void add_interface_forces(std::span<const std::uint32_t> points, std::span<const double> force) {
    engine_.add_interface_forces(points, force);
  }
  void integrate() {
    {
      const Stopwatch stopwatch(integrate_seconds);
      engine_.integrate();
    }
    output_.write_cracks();
  }

  double force_seconds = 0.0, integrate_seconds = 0.0;

private:
  /// A check costs some steps: once in a hundred where contacts come and go, else in a thousand.
  bool is_due_for_check() const {
    return engine_.step() % 1000 == 0 ||
           (engine_.step() % 100 == 0 && engine_.renewals() != renewals_);
  }
  void check_step() {
    renewals_ = engine_.renewals();
    const StepLimit limit = engine_.step_limit();
    const double critical = 2.0 / std::sqrt(limit.omega2); // Rojek (2008) eq. 10
    if (*time_step_ > critical)
      throw std::runtime_error(
          fmt::format("the time step of {:.4g} s is above the critical one, which has fallen to "
                      "{:.4g} s with the contacts of {}; give case.time_step a smaller number or "
                      "case.time_step_factor more room",
                      *time_step_, critical, limit.limited_by));
  }

  Engine<dim>& engine_;
  DemOutput<dim>& output_;
  Stages<dim>& stages_;
  bool is_coupled_;
  std::optional<double> time_step_;
  std::size_t renewals_ = 0;
};

template <int dim> Engine<dim> make_engine(const json& table, const json& case_table) {
  Settings<dim> settings = read_settings<dim>(table, case_table);
  put_in_spatial_order(settings);
  try {
    return Engine<dim>(settings);
  } catch (const ImpossibleStress& error) {
    throw SettingsError("in_situ_stress", error.what());
  } catch (const std::invalid_argument& error) {
    throw SettingsError("particles", error.what());
  }
}

template <int dim> coupler::Declaration declare(const Engine<dim>& engine) {
  coupler::Declaration d;
  d.dimension = dim;
  const Particles<dim>& p = engine.particles();
  d.ids.assign(p.ids.begin(), p.ids.end());
  for (const Vec<dim>& x : p.reference)
    d.positions.insert(d.positions.end(), x.begin(), x.end());
  d.stiffness = engine.stiffness();
  d.radii = p.radius;
  d.memory_estimate = engine.memory();
  d.has_checkpoints = d.has_stages = true;
  return d;
}

template <int dim>
coupler::Limits limits_of(const Engine<dim>& engine, const coupler::Plan& plan,
                          const json& case_table) {
  coupler::Limits limits;
  for (const coupler::Interface& interface : plan.interfaces) {
    std::vector<double> inverse_mass(interface.points.size() * dim);
    std::vector<double> omega2(interface.points.size());
    engine.inverse_mass(interface.points, inverse_mass);
    engine.omega2(interface.points, omega2);
    limits.inverse_mass.push_back(std::move(inverse_mass));
    limits.omega2.push_back(std::move(omega2));
  }
  StepLimit own = engine.step_limit();
  if (!case_table.value("time_step", json()).is_number()) // a given one is compared with what is
    if (const StepLimit to_come = engine.step_limit_to_come(); to_come.omega2 > own.omega2)
      own = to_come;
  limits.largest_omega2 = own.omega2;
  limits.limited_by = own.limited_by;
  return limits;
}

/// The one to go on from, if any; read before anything is built on it.
std::optional<Checkpoint> read_restart(const coupler::Participant& broker) {
  const std::filesystem::path file = broker.restart_file();
  if (file.empty())
    return std::nullopt;
  try {
    return read_checkpoint(file, checkpoint_writer);
  } catch (const CheckpointError& error) {
    throw SettingsError(
        "", fmt::format("{}\ngo on from another one, with --restart DIR@STEP", error.what()));
  }
}

/// Before the broker sees to a run that goes on from it.
template <int dim> void check(const Engine<dim>& engine, const Checkpoint& checkpoint) {
  try {
    engine.check_model(checkpoint.state);
  } catch (const std::invalid_argument& error) {
    throw SettingsError("", fmt::format("the checkpoint does not fit the case: {}\ngo on from a "
                                        "checkpoint of this case",
                                        error.what()));
  }
}

/// The interface needs particles that move by their own mass.
template <int dim>
void refuse_coupled_clusters(const Engine<dim>& engine, const coupler::Plan& plan) {
  for (const coupler::Interface& interface : plan.interfaces)
    for (const std::uint32_t i : interface.points)
      if (engine.particles().is_member(i))
        throw SettingsError("clusters",
                            fmt::format("particle {} of a cluster is in an overlap with a mesh\n"
                                        "keep clusters out of the overlap",
                                        engine.particles().ids[i]));
}

/// What was added to the masses, for the log and the summary; null when they are not scaled.
template <int dim> json mass_scaling_of(const Engine<dim>& engine, const json& table) {
  if (table.value("mass_scaling", json()).is_null())
    return nullptr;
  const AddedMass mass = engine.added_mass();
  spdlog::info("mass scaling: {} of {} particles are heavier, {:.4g} kg are added to {:.4g} kg; "
               "most of all particle {}, by a factor of {:.4g}. Waves are "
               "slower, weight and static results are not changed.",
               mass.particles, engine.size(), mass.added, mass.before, mass.largest_id,
               mass.largest_factor);
  return {{"particles", mass.particles},
          {"added_mass", mass.added},
          {"true_mass", mass.before},
          {"largest_factor", mass.largest_factor},
          {"largest_factor_particle", mass.largest_id}};
}

/// The stress at the start, for the log and the summary; null without one.
template <int dim> json in_situ_stress_of(const Engine<dim>& engine) {
  if (!engine.in_situ_stress())
    return nullptr;
  const InSituReport<dim>& report = *engine.in_situ_stress();
  spdlog::info("in-situ stress: the mean is [{:.6g}] Pa, wanted were [{:.6g}] Pa; the bulk density "
               "is {:.5g} kg/m³. {} bonds and {} contacts with tools carry it, {} contacts with "
               "tools are open, {} particles have too few bonds. No resultant exceeds {:.2g} of "
               "the mean contact force.",
               fmt::join(report.found, ", "), fmt::join(report.wanted, ", "), report.bulk_density,
               report.bonds, report.wall_contacts, report.open_contacts, report.without_stress,
               report.unbalanced);
  return {{"mean_stress", std::vector<double>(report.found.begin(), report.found.end())},
          {"bulk_density", report.bulk_density},
          {"unbalanced", report.unbalanced},
          {"particles_without_stress", report.without_stress}};
}

template <int dim>
int run(coupler::Participant& broker, const json& table, const json& case_table) {
  Watch<dim> watch = read_watch<dim>(table);
  const std::optional<Checkpoint> checkpoint = read_restart(broker);
  Engine<dim> engine = make_engine<dim>(table, case_table);
  Stages<dim> stages(table, engine, watch.probes);
  watch.has_stages = stages.size() > 0;
  if (checkpoint)
    check(engine, *checkpoint);
  const coupler::Plan& plan = broker.declare(declare(engine));
  refuse_coupled_clusters(engine, plan);
  engine.set_weights(plan.weights);
  const coupler::Schedule& schedule = broker.initialize(limits_of(engine, plan, case_table));

  const json scaling = mass_scaling_of(engine, table);
  const json stress = in_situ_stress_of(engine);
  const coupler::Assignment& assignment = broker.assignment();
  if (assignment.plan_only) {
    broker.finalize();
    return 0;
  }
  engine.start(schedule.time_step);
  const std::size_t stage = broker.stage_before(schedule.first_step);
  if (checkpoint) {
    stages.adopt(stage);
    engine.restore(checkpoint->state);
  }
  DemOutput<dim> output(engine, watch, assignment.run_folder, assignment.name);
  if (watch.has_stages)
    output.set_stage(stage);
  RecordedEngine<dim> recorded(
      engine, output, stages, !plan.interfaces.empty(),
      case_table.value("allow_unstable", false) ? std::nullopt : std::optional(schedule.time_step));
  coupler::run_engine(recorded, broker, plan, schedule, output);

  json summary = {{"seconds",
                   {{"forces", recorded.force_seconds},
                    {"integrate", recorded.integrate_seconds},
                    {"output", output.seconds()}}},
                  {"threads", omp_get_max_threads()},
                  {"particles", engine.size()},
                  {"contacts", engine.contacts().size()},
                  {"contact_list_renewals", engine.renewals()}};
  if (!scaling.is_null())
    summary["mass_scaling"] = scaling;
  if (!stress.is_null())
    summary["in_situ_stress"] = stress;
  broker.finalize(summary.dump());
  return 0;
}

} // namespace

int run_dem(coupler::Participant& broker) {
  const json table = json::parse(broker.assignment().settings);
  const json case_table = json::parse(broker.assignment().case_settings);
  if (const auto threads = read_threads(table))
    omp_set_num_threads(*threads);
  const int dimension = case_table.value("dimension", 0);
  if (dimension == 2)
    return run<2>(broker, table, case_table);
  if (dimension == 3)
    return run<3>(broker, table, case_table);
  throw SettingsError("", fmt::format("the dimension {} must be 2 or 3", dimension));
}

} // namespace kerf::dem
