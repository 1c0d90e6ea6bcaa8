// The loop of every kerf engine: five calls a step, frames and histories when they are due.
#pragma once

#include "coupler/participant/participant.hpp"

namespace kerf::coupler {

/// Runs an engine as one participant, until the broker ends the run.
///
/// An engine with stages has begin_stage(stage), before the first step of each, and met(stage,
/// first step), which gives the name and the value of a stop condition that this step meets.
///
/// @param output  write_frame(step, time) gets the state x^n, v^(n-1/2); write_history(step, time)
///                gets the energies of t_n, after integrate(); write_checkpoint(file) gets the
///                state between two steps
template <class Engine, class Output>
void run_engine(Engine& engine, Participant& broker, const Plan& plan, const Schedule& schedule,
                Output& output) {
  const auto& interfaces = plan.interfaces;
  const auto write_checkpoint = [&] {
    if (!broker.checkpoint_is_due())
      return;
    output.write_checkpoint(broker.checkpoint_file());
    broker.report_checkpoint();
  };
  while (broker.has_next_step()) {
    const std::uint64_t n = broker.step();
    write_checkpoint(); // before anything of this step is in the results
    if constexpr (requires { engine.begin_stage(broker.stage()); })
      if (n == broker.stage_begin())
        engine.begin_stage(broker.stage());
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
    if constexpr (requires { engine.met(broker.stage(), broker.stage_begin()); })
      if (const auto met = engine.met(broker.stage(), broker.stage_begin()))
        broker.report_condition(met->name, met->value);
    if (n % schedule.history_every == 0 || n + 1 == schedule.steps)
      output.write_history(n, broker.time());
  }
  write_checkpoint();
  if (schedule.frame_every != 0)
    output.write_frame(schedule.steps, broker.time());
}

} // namespace kerf::coupler
