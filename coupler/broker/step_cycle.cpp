// The steps of a coupled run: motions in, forces out, books afterwards.
#include "coupler/broker/members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kerf::coupler {

void Broker::step_loop() {
  for (Joint& joint : joints_)
    joint.history.emplace(setup_.run_folder / "history" / (joint.name + ".csv"),
                          std::vector<Column>{{"step", "1"},
                                              {"time", "s"},
                                              {"momentum_residual", "1"},
                                              {"angular_momentum_residual", "1"},
                                              {"constraint_violation", "m"},
                                              {"work_on_particles", "J"},
                                              {"work_on_mesh", "J"},
                                              {"stored_energy", "J"}},
                          schedule_.first_step);
  const auto start = Clock::now();
  for (Member& m : members_)
    m.heard = start;
  if (!joints_.empty()) {
    for (step_ = schedule_.first_step; step_ < schedule_.steps; ++step_) {
      if (checkpoint_is_due())
        write_couplings();
      cycle();
    }
    if (checkpoint_is_due())
      write_couplings();
  }
  await_finish();
  loop_seconds_ = std::chrono::duration<double>(Clock::now() - start).count();
}

void Broker::cycle() {
  for (Member& m : members_)
    if (m.channel) {
      m.own_frame = {};
      m.motion_frame = receive_frame(m, FrameKind::motion);
    }
  for (Member& m : members_)
    if (m.channel) {
      m.force_frame = force_frame_of(m);
      m.layout.write_header(m.force_frame, FrameKind::interface_forces, step_);
    }
  for (Joint& joint : joints_) // the participants compute their own forces meanwhile
    if (!joint.coupling->needs_own_forces())
      compute(joint);
  for (Member& m : members_)
    if (m.channel && m.plan.needs_own_forces) {
      // The participant may write its next motion where this one stands as soon as it goes on.
      m.motion_copy.assign(m.motion_frame.begin(), m.motion_frame.end());
      m.motion_frame = m.motion_copy;
      m.own_frame = receive_frame(m, FrameKind::own_forces);
    }
  for (Joint& joint : joints_)
    if (joint.coupling->needs_own_forces())
      compute(joint);
  for (Member& m : members_)
    if (m.channel)
      send_forces(m);
  enter_books();
  // Messages and children are looked after ten times a second, whatever a step takes.
  if (Clock::now() - last_service_ > std::chrono::milliseconds(100))
    serve(std::chrono::milliseconds(0));
}

void Broker::compute(Joint& joint) {
  std::span<double> force[2];
  for (int s = 0; s < 2; ++s)
    force[s] = joint.side[s]->layout.values(joint.side[s]->force_frame, FrameKind::interface_forces,
                                            joint.interface[s], Field::force);
  joint.coupling->compute(step_, joint.side[0]->motion(joint.interface[0]),
                          joint.side[1]->motion(joint.interface[1]), force[0], force[1]);
}

void Broker::enter_books() {
  const bool due = step_ % schedule_.history_every == 0 || step_ + 1 == schedule_.steps;
  for (Joint& joint : joints_) {
    const Coupling::Motion motion[2] = {joint.side[0]->motion(joint.interface[0]),
                                        joint.side[1]->motion(joint.interface[1])};
    std::span<const double> force[2];
    for (int s = 0; s < 2; ++s)
      force[s] = joint.side[s]->layout.values(
          std::span<const std::byte>(joint.side[s]->force_frame), FrameKind::interface_forces,
          joint.interface[s], Field::force);
    joint.coupling->enter_books(step_, motion[0], motion[1], force[0], force[1]);
    const CouplingBook& book = joint.coupling->book();
    if (!book.finite)
      blame_not_finite(joint);
    if (due)
      joint.history->append(
          std::array{static_cast<double>(step_), static_cast<double>(step_) * schedule_.time_step,
                     book.momentum_residual, book.angular_momentum_residual,
                     book.constraint_violation, book.work[0], book.work[1], book.stored_energy});
  }
}

/// Finds out whose numbers are not finite, and which point has them.
void Broker::blame_not_finite(const Joint& joint) const {
  for (int s = 0; s < 2; ++s) {
    const Member& m = *joint.side[s];
    const Coupling::Motion motion = m.motion(joint.interface[s]);
    const auto dim = static_cast<std::size_t>(m.declaration.dimension);
    for (const auto& [values, what] :
         {std::pair{motion.position, "position"}, std::pair{motion.velocity, "velocity"},
          std::pair{motion.own_forces, "force"}})
      for (std::size_t k = 0; k < values.size(); ++k)
        if (!std::isfinite(values[k])) {
          const std::uint32_t point = m.plan.interfaces[joint.interface[s]].points[k / dim];
          throw RunError(ErrorKind::failed, "",
                         fmt::format("participant \"{}\" (pid {}) sent a {} that is not a number "
                                     "(id {}) at step {} of {}. Its log: {}",
                                     m.name, m.pid, what, m.declaration.ids[point], step_,
                                     schedule_.steps, log_of(m).string()));
        }
  }
  throw RunError(ErrorKind::failed, "",
                 fmt::format("the forces of coupling \"{}\" overflowed at step {} of {}",
                             joint.name, step_, schedule_.steps));
}

Wait Broker::patience() {
  const double limit = setup_.settings.at("case").at("hang_limit");
  return {.limit =
              std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limit)),
          .idle = [this] { serve(std::chrono::milliseconds(0)); }};
}

std::span<const std::byte> Broker::receive_frame(Member& m, FrameKind kind) {
  try {
    const auto frame = m.channel->receive(patience());
    check_frame(frame, kind, step_, m.layout);
    return frame;
  } catch (const TimeoutError& error) {
    gave_up(m, kind == FrameKind::motion ? "motion" : "own forces", error);
  } catch (const ProtocolError& error) {
    throw RunError(ErrorKind::failed, "",
                   fmt::format("participant \"{}\" (pid {}) broke the protocol at step {}: {}",
                               m.name, m.pid, step_, error.what()));
  }
}

std::span<std::byte> Broker::force_frame_of(Member& m) {
  try {
    return m.channel->outgoing(patience());
  } catch (const TimeoutError& error) {
    gave_up(m, "taking of the last forces", error);
  }
}

void Broker::send_forces(Member& m) {
  try {
    m.channel->send(m.layout.bytes(FrameKind::interface_forces));
  } catch (const TimeoutError& error) {
    gave_up(m, "taking of the forces", error);
  }
}

void Broker::gave_up(const Member& m, const char* expected, const TimeoutError& error) {
  // Perhaps it has died: its end or its last message says more, and may be on the way.
  for (int k = 0; k < 20; ++k)
    serve(std::chrono::milliseconds(10));
  const double limit = setup_.settings.at("case").at("hang_limit");
  const bool closed = dynamic_cast<const ClosedError*>(&error) != nullptr;
  throw RunError(
      ErrorKind::failed, "",
      fmt::format("participant \"{}\" (pid {}) {} at step {} of {}; its {} was "
                  "expected. Its log: {}. {}",
                  m.name, m.pid,
                  closed ? "closed its link" : fmt::format("was silent for {:g} s", limit), step_,
                  schedule_.steps, expected, log_of(m).string(), last_checkpoint()));
}

} // namespace kerf::coupler
