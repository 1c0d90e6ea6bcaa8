#include "fem_core/program/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kerf::fem {

template <int dim>
Guard<dim>::Guard(Engine<dim>& engine, double time_step, bool is_unstable, bool is_alone)
    : engine_(engine), time_step_(time_step), is_unstable_(is_unstable), is_alone_(is_alone),
      deforms_(
          std::ranges::any_of(engine.settings().materials, [](const MaterialSetting<dim>& setting) {
            return setting.material.finite_strain ||
                   std::holds_alternative<NeoHookean>(setting.material.law);
          })) {}

/// What is wrong with the state of the engine.
template <int dim> std::optional<std::string> Guard<dim>::fault() const {
  if (const auto node = engine_.first_non_finite())
    return fmt::format("the motion of node {} is not a finite number", *node);
  if (!deforms_)
    return std::nullopt;
  if (is_unstable_) {
    const auto element = engine_.first_inverted();
    return element ? std::optional(engine_.name_of(*element) + " has turned inside out")
                   : std::nullopt;
  }
  try {
    const StepLimit limit = engine_.step_limit();
    const double critical = 2.0 / std::sqrt(limit.omega2);
    if (time_step_ <= critical * (1.0 + 1e-9)) // they may be equal at the start
      return std::nullopt;
    return fmt::format("the time step of {:.6g} s is above the critical one, which has fallen to "
                       "{:.6g} s with {}; give case.time_step a smaller number or "
                       "case.time_step_factor more room",
                       time_step_, critical, limit.limited_by);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

template <int dim> void Guard<dim>::look() {
  std::optional<std::string> found = fault();
  if (!found) {
    if (deforms_)
      good_ = engine_.state();
    return;
  }
  std::uint64_t lost = engine_.step();
  if (!good_.empty()) {
    engine_.restore(good_);
    while (is_alone_ && lost - engine_.step() > 1) {
      const std::uint64_t middle = engine_.step() + (lost - engine_.step()) / 2;
      while (engine_.step() < middle)
        engine_.integrate();
      if (auto earlier = fault()) {
        found = std::move(earlier);
        lost = middle;
        engine_.restore(good_);
      } else {
        good_ = engine_.state();
      }
    }
  }
  throw LostBody(fmt::format("{}, at t = {:.9g} s (step {})", *found,
                             static_cast<double>(lost) * time_step_, lost));
}

template class Guard<2>;
template class Guard<3>;

} // namespace kerf::fem
