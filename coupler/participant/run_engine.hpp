// The loop of every kerf engine: five calls a step, frames and histories when they are due.
#pragma once

#include "coupler/participant/participant.hpp"

namespace kerf::coupler {

/// Runs an engine as one participant, until the broker ends the run.
///
/// @param output  write_frame(step, time) gets the state x^n, v^(n-1/2); write_history(step, time)
///                gets the energies of t_n, after integrate()
template <class Engine, class Output>
void run_engine(Engine& engine, Participant& broker, const Plan& plan, const Schedule& schedule,
                Output& output) {
  const auto& interfaces = plan.interfaces;
  while (broker.has_next_step()) {
    const std::uint64_t n = broker.step();
    if (schedule.frame_every != 0 && n % schedule.frame_every == 0)
      output.write_frame(n, broker.time());
    for (std::size_t k = 0; k < interfaces.size(); ++k)
      engine.motion(interfaces[k].points, broker.position(k), broker.velocity(k));
    broker.publish_motion();
    engine.compute_own_forces(); // meanwhile the broker computes the penalty
    if (plan.needs_own_forces)
      for (std::size_t k = 0; k < interfaces.size(); ++k)
        engine.own_forces(interfaces[k].points, broker.own_forces(k));
    broker.publish_forces();
    broker.receive();
    for (std::size_t k = 0; k < interfaces.size(); ++k)
      engine.add_interface_forces(interfaces[k].points, broker.interface_forces(k));
    engine.integrate();
    if (n % schedule.history_every == 0 || n + 1 == schedule.steps)
      output.write_history(n, broker.time());
  }
  if (schedule.frame_every != 0)
    output.write_frame(schedule.steps, broker.time());
}

} // namespace kerf::coupler
