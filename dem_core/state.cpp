#include "dem_core/state.hpp"

#include "dem_core/engine.hpp"

#include <bit>
#include <stdexcept>

namespace kerf::dem {

namespace {

constexpr const char* model = "model";

/// A number that nearly every other model does not have, by its particles and tools.
template <int dim> std::uint64_t fingerprint(const Engine<dim>& engine) {
  std::uint64_t sum = 0xcbf29ce484222325u;
  const auto add = [&](double number) {
    sum = (sum ^ std::bit_cast<std::uint64_t>(number)) * 0x100000001b3u;
  };
  const Particles<dim>& p = engine.particles();
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (const double x : p.reference[i])
      add(x);
    add(p.radius[i]);
    add(p.ids[i]);
    if (!p.material.empty())
      add(p.material[i]);
  }
  add(static_cast<double>(engine.tools().size()));
  return sum;
}

} // namespace

template <int dim> State Engine<dim>::state() const {
  State state;
  state[model] = std::vector<std::uint64_t>{fingerprint(*this)};
  StateWriter writer(state);
  visit_parts(const_cast<Engine&>(*this), writer); // which only reads
  return state;
}

template <int dim> void Engine<dim>::check_model(const State& state) const {
  std::uint64_t saved = 0;
  StateReader reader(state);
  reader(model, saved);
  if (saved != fingerprint(*this))
    throw std::invalid_argument("it has other particles or tools");
}

template <int dim> void Engine<dim>::restore(const State& state) {
  check_model(state);
  std::uint64_t saved = 0;
  StateReader reader(state);
  reader(model, saved);
  visit_parts(*this, reader);
  reader.finish();
  contacts_.clear_until.clear();
  forces_are_current_ = interface_forces_are_old_ = false;
}

template State Engine<2>::state() const;
template State Engine<3>::state() const;
template void Engine<2>::check_model(const State&) const;
template void Engine<3>::check_model(const State&) const;
template void Engine<2>::restore(const State&);
template void Engine<3>::restore(const State&);

} // namespace kerf::dem
