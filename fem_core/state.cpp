// What of the engine is its state: everything that steps change. The rest comes from mesh and
// settings.
#include "common/state.hpp"

#include "fem_core/engine.hpp"

#include <bit>
#include <stdexcept>

namespace kerf::fem {

/// Every part names all of its members, so that a new one does not compile unlisted.
struct StateParts {
  template <class Visit> static void of(WorkBook& book, Visit& visit) {
    auto& [total, at_step] = book;
    visit("total", total);
    visit("at_step", at_step);
  }

  /// Forces are computed anew in every step, and what was before t_n is overwritten.
  template <int dim, class Visit> static void of(Engine<dim>& engine, Visit& visit) {
    auto& [mesh, settings, boundary, loads, absorbing, walls, material_of, alpha, removed, active,
           patches, groups, group_of, place, reference, mass, moved, time_step, step, changed_at,
           displacement, velocity, initial_displacement, origin, support, force, parts,
           forces_are_current, prescribed, scratch, interface_rows, interface_force, element_work,
           patch_work, patch_sums, sums, load_force, reactions, wall_forces, damped_work,
           external_work, interface_work] = engine;
    visit("time_step", time_step);
    visit("step", step);
    visit("displacement", displacement);
    visit("velocity", velocity);
    visit("changed_at", changed_at);
    visit("initial_displacement", initial_displacement);
    visit("origin", origin);
    visit("support", support);
    visit("groups", groups);
    visit("element_work", element_work);
    visit("damped_work", damped_work);
    visit("external_work", external_work);
    visit("interface_work", interface_work);
  }
  template <class Visit> static void of(GroupKernel& group, Visit& visit) {
    auto& [compute, kinematics, increments, points, law, parameters, moduli, constants, alpha,
           length, compute_dilatation, dilatation, stress, history, hourglass, initial_history] =
        group;
    visit("stress", stress);
    visit("history", history);
    visit("hourglass", hourglass);
  }
  template <class Visit> static void of(ElementWork& work, Visit& visit) {
    auto& [internal, dissipated, hourglass, viscous] = work;
    visit("internal", internal);
    visit("dissipated", dissipated);
    visit("hourglass", hourglass);
    visit("viscous", viscous);
  }
  template <int dim, class Visit> static void of(Rows<dim>& rows, Visit& visit) {
    visit("row", rows.rows_);
  }
};

template <class Part, class Visit> void visit_parts(Part& part, Visit& visit) {
  StateParts::of(part, visit);
}

namespace {

constexpr const char* model = "model";

/// A number that nearly every other mesh does not have.
template <int dim> std::uint64_t fingerprint(const Mesh<dim>& mesh) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  const auto add = [&](std::uint64_t word) { sum = (sum ^ word) * 0x100000001b3u; };
  for (const double x : mesh.positions)
    add(std::bit_cast<std::uint64_t>(x));
  for (const Block& block : mesh.blocks)
    for (const std::uint32_t node : block.nodes)
      add(node);
  return sum;
}

} // namespace

template <int dim> State Engine<dim>::state() const {
  State state;
  state[model] = std::vector<std::uint64_t>{fingerprint(mesh_)};
  StateWriter writer(state);
  visit_parts(const_cast<Engine&>(*this), writer); // which only reads
  return state;
}

template <int dim> void Engine<dim>::check_model(const State& state) const {
  std::uint64_t saved = 0;
  StateReader reader(state);
  reader(model, saved);
  if (saved != fingerprint(mesh_))
    throw std::invalid_argument("it has another mesh");
}

template <int dim> void Engine<dim>::restore(const State& state) {
  check_model(state);
  std::uint64_t saved = 0;
  StateReader reader(state);
  reader(model, saved);
  visit_parts(*this, reader);
  reader.finish();
}

template State Engine<2>::state() const;
template State Engine<3>::state() const;
template void Engine<2>::check_model(const State&) const;
template void Engine<3>::check_model(const State&) const;
template void Engine<2>::restore(const State&);
template void Engine<3>::restore(const State&);

} // namespace kerf::fem
