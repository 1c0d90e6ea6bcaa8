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
    auto& [mesh, settings, boundary, elements, mass, inverse_mass, element_omega2, moved, time_step,
           step, displacement, displacement_before, velocity, velocity_before, initial_displacement,
           element_force, own_force, interface_force, has_interface_force, external_work,
           interface_work] = engine;
    visit("time_step", time_step);
    visit("step", step);
    visit("displacement", displacement);
    visit("displacement_before", displacement_before);
    visit("velocity", velocity);
    visit("velocity_before", velocity_before);
    visit("initial_displacement", initial_displacement);
    visit("external_work", external_work);
    visit("interface_work", interface_work);
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
  for (const std::uint32_t node : mesh.elements)
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
