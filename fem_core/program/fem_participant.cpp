#include "fem_core/program/fem_participant.hpp"

#include "common/checkpoint.hpp"
#include "coupler/participant/run_engine.hpp"
#include "fem_core/engine.hpp"
#include "fem_core/input_error.hpp"
#include "fem_core/mesh/quality.hpp"
#include "fem_core/program/output.hpp"
#include "fem_core/program/read_materials.hpp"
#include "fem_core/program/read_mesh.hpp"
#include "fem_core/program/read_settings.hpp"
#include "fem_core/program/stages.hpp"

#include <omp.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

namespace kerf::fem {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The engine in the loop of a run: with its stages, and with looks at what becomes of the body.
template <int dim> class SteppedEngine {
public:
  /// @param is_coupled  somebody asks for the own forces before the step is made; else integrate()
  ///                    has them in its one pass over the memory
  SteppedEngine(Engine<dim>& engine, Output<dim>& output, Stages<dim>& stages,
                const Watch<dim>& watch, bool is_coupled)
      : engine_(engine), output_(output), stages_(stages), watch_(watch), is_coupled_(is_coupled) {}

  void begin_stage(std::size_t stage) {
    if (stages_.size() == 0)
      return;
    stages_.begin(stage);
    output_.set_stage(stage);
    output_.look();
  }
  /// The condition that the step which has just been integrated meets.
  std::optional<Met> met(std::size_t stage, std::uint64_t begin) const {
    return stages_.met(stage, begin, watch_);
  }

  void motion(std::span<const std::uint32_t> nodes, std::span<double> position,
              std::span<double> velocity) const {
    engine_.motion(nodes, position, velocity);
  }
  void compute_own_forces() {
    output_.look_if_due();
    if (is_coupled_)
      engine_.compute_own_forces();
  }
  void own_forces(std::span<const std::uint32_t> nodes, std::span<double> force) const {
    engine_.own_forces(nodes, force);
  }
  void add_interface_forces(std::span<const std::uint32_t> nodes, std::span<const double> force) {
    engine_.add_interface_forces(nodes, force);
  }
  void integrate() { engine_.integrate(); }

private:
  Engine<dim>& engine_;
  Output<dim>& output_;
  Stages<dim>& stages_;
  const Watch<dim>& watch_;
  bool is_coupled_;
};

template <int dim> coupler::Declaration declare(const Mesh<dim>& mesh) {
  constexpr double per_element = 100.0; // indices, and what some laws store
  constexpr double per_node = 8.0 * row_size<dim> * sizeof(double); // rows of the state, the mesh

  coupler::Declaration declaration;
  declaration.dimension = dim;
  declaration.ids.resize(mesh.num_nodes());
  std::iota(declaration.ids.begin(), declaration.ids.end(), 0);
  declaration.positions = mesh.positions;
  if (mesh.blocks.size() == 1) { // TODO(issue 5): zones through meshes of two shapes
    declaration.nodes_per_element = nodes_of(mesh.blocks[0].shape);
    declaration.elements = mesh.blocks[0].nodes;
    for (const auto& [tag, faces] : mesh.boundary)
      for (const Face& face : faces) {
        const auto nodes = mesh.nodes_of_face(face);
        auto& of_tag = declaration.boundary[tag];
        of_tag.insert(of_tag.end(), nodes.begin(), nodes.end());
      }
  }
  declaration.memory_estimate = per_element * static_cast<double>(mesh.num_elements()) +
                                per_node * static_cast<double>(mesh.num_nodes());
  declaration.has_checkpoints = declaration.has_stages = true;
  return declaration;
}

template <int dim> coupler::Limits limits(const Engine<dim>& engine, const coupler::Plan& plan) {
  coupler::Limits limits;
  for (const coupler::Interface& interface : plan.interfaces) {
    engine.inverse_mass(interface.points,
                        limits.inverse_mass.emplace_back(interface.points.size() * dim));
    engine.omega2(interface.points, limits.omega2.emplace_back(interface.points.size()));
  }
  const StepLimit own = engine.step_limit();
  limits.largest_omega2 = own.omega2;
  limits.limited_by = own.limited_by;
  return limits;
}

/// The one to go on from, if any; read before anything is built on it.
std::optional<Checkpoint> read_restart(const coupler::Participant& participant) {
  const std::filesystem::path file = participant.restart_file();
  if (file.empty())
    return std::nullopt;
  try {
    return read_checkpoint(file, checkpoint_writer);
  } catch (const CheckpointError& error) {
    throw coupler::SettingsError(
        "", fmt::format("{}\ngo on from another one, with --restart DIR@STEP", error.what()));
  }
}

/// Before the broker sees to a run that goes on from it.
template <int dim> void check(const Engine<dim>& engine, const Checkpoint& checkpoint) {
  try {
    engine.check_model(checkpoint.state);
  } catch (const std::invalid_argument& error) {
    throw coupler::SettingsError(
        "", fmt::format("the checkpoint does not fit the case: {}\ngo on from a "
                        "checkpoint of this case",
                        error.what()));
  }
}

/// What may be wrong with a case that can be run, for the log and the user.
template <int dim>
nlohmann::json warnings_of(const Engine<dim>& engine, const Table& case_settings) {
  double wave_speed = 0.0; // m/s
  for (const MaterialSetting<dim>& setting : engine.settings().materials) {
    const Material& material = setting.material;
    wave_speed = std::max(wave_speed, std::sqrt(material.bound().uniaxial() / material.density()));
  }
  const double duration =
      case_settings.number("end_time", std::numeric_limits<double>::infinity()); // s
  nlohmann::json warnings = nlohmann::json::array();
  if (const auto doubt = doubt_of_unit(quality_of(engine.mesh()), wave_speed * duration)) {
    spdlog::warn("{}", *doubt);
    warnings.push_back(*doubt);
  }
  return warnings;
}

/// What was added to the masses, for the log and the summary; null when they are not scaled.
template <int dim> nlohmann::json mass_scaling_of(const Engine<dim>& engine) {
  if (!engine.settings().mass_scaling)
    return nullptr;
  const AddedMass mass = engine.added_mass();
  spdlog::info("mass scaling: {} of {} elements are heavier, {:.4g} kg are added to {:.4g} kg; "
               "most of all {}, by a factor of {:.4g}. Waves are slower, weight and static results "
               "are not changed.",
               mass.elements, engine.active_elements().size(), mass.added, mass.before,
               engine.name_of(mass.largest_element), mass.largest_factor);
  return {{"elements", mass.elements},
          {"added_mass", mass.added},
          {"true_mass", mass.before},
          {"largest_factor", mass.largest_factor},
          {"largest_factor_element", mass.largest_element}};
}

template <int dim>
void run(coupler::Participant& participant, const Table& settings, const Table& case_settings) {
  const auto begin = Clock::now();
  const std::optional<Checkpoint> checkpoint = read_restart(participant);
  const Mesh<dim> mesh = read_mesh(settings, read_period<dim>(case_settings));
  Engine<dim> engine(mesh, read_settings(settings, mesh));
  Watch<dim> watch = read_watch(settings, mesh);
  Stages<dim> stages(settings, participant.assignment().name, engine, watch);
  if (checkpoint)
    check(engine, *checkpoint);
  const coupler::Plan& plan = participant.declare(declare(mesh));
  engine.set_weights(plan.weights);
  const coupler::Schedule& schedule = participant.initialize(limits(engine, plan));
  const nlohmann::json warnings = warnings_of(engine, case_settings);
  const nlohmann::json scaling = mass_scaling_of(engine);
  const coupler::Assignment& assignment = participant.assignment();
  if (assignment.plan_only) {
    participant.finalize(
        nlohmann::json({{"elements", mesh.num_elements()}, {"warnings", warnings}}).dump());
    return;
  }
  engine.start(schedule.time_step);
  const std::size_t stage = participant.stage_before(schedule.first_step);
  if (checkpoint) {
    stages.adopt(stage);
    engine.restore(checkpoint->state);
  }
  watch.time_step = schedule.time_step;
  const bool is_coupled = !plan.interfaces.empty();
  Guard<dim> guard(engine, schedule.time_step, case_settings.flag("allow_unstable", false),
                   !is_coupled);
  Output<dim> output(engine, std::move(guard), watch, plan.weights, assignment.run_folder,
                     assignment.name);
  if (watch.has_stages)
    output.set_stage(stage);
  const double setup = seconds_since(begin);
  SteppedEngine<dim> stepped(engine, output, stages, watch, is_coupled);
  coupler::run_engine(stepped, participant, plan, schedule, output);
  const double total = seconds_since(begin);
  nlohmann::json summary = {{"seconds",
                             {{"setup", setup},
                              {"steps", total - setup - output.seconds()},
                              {"output", output.seconds()}}},
                            {"threads", omp_get_max_threads()},
                            {"nodes", mesh.num_nodes()},
                            {"elements", engine.active_elements().size()},
                            {"warnings", warnings}};
  if (!scaling.is_null())
    summary["mass_scaling"] = scaling;
  participant.finalize(summary.dump());
}

} // namespace

int run_fem(coupler::Participant& participant) {
  const auto settings_json = nlohmann::json::parse(participant.assignment().settings);
  const auto case_json = nlohmann::json::parse(participant.assignment().case_settings);
  const Table settings(settings_json, "");
  const Table case_settings(case_json, "");
  if (const auto threads = read_threads(settings))
    omp_set_num_threads(*threads);
  const std::uint64_t dimension = case_settings.count("dimension");
  try {
    if (dimension == 2)
      run<2>(participant, settings, case_settings);
    else if (dimension == 3)
      run<3>(participant, settings, case_settings);
    else
      throw coupler::SettingsError("", fmt::format("the case has {} dimensions; kerf-fem can do 2 "
                                                   "and 3",
                                                   dimension));
  } catch (const InputError& error) {
    throw coupler::SettingsError(case_key(settings, error.key()), error.what());
  }
  return 0;
}

} // namespace kerf::fem
