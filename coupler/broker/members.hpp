// What the broker knows of each participant and of each coupling between two of them.
#pragma once

#include "common/history.hpp"
#include "coupler/broker/broker.hpp"

#include <optional>

namespace kerf::coupler {

struct Broker::Member {
  std::string name;
  std::string kind;    // "dem", "fem"
  std::string program; // as it introduced itself
  std::string peer;    // on the control socket; empty: not connected yet
  std::int64_t pid = 0;
  bool answered = false; // what is being collected
  bool finished = false;
  std::uint64_t step = 0;       // by its own last word
  std::uint64_t checkpoint = 0; // step of the last one that it has written; 0: none
  Clock::time_point heard{};    // when it last said anything

  Declaration declaration;
  Plan plan;
  Limits limits;
  Finished timing;

  // Only with interfaces.
  int segment = -1;
  ChannelAddress address;
  std::unique_ptr<Channel> channel;
  FrameLayout layout;
  std::span<const std::byte> motion_frame, own_frame;
  std::vector<std::byte> motion_copy; // where the own forces would overwrite the motion
  std::span<std::byte> force_frame;

  /// Motion of an interface; own forces as soon as they are there.
  Coupling::Motion motion(std::size_t interface) const {
    Coupling::Motion motion{
        layout.values(motion_frame, FrameKind::motion, interface, Field::position),
        layout.values(motion_frame, FrameKind::motion, interface, Field::velocity),
        {}};
    if (!own_frame.empty())
      motion.own_forces = layout.values(own_frame, FrameKind::own_forces, interface, Field::force);
    return motion;
  }
};

struct Broker::Joint {
  std::string name;
  std::unique_ptr<Coupling> coupling;
  Member* side[2] = {nullptr, nullptr}; // particles, mesh
  std::size_t interface[2] = {0, 0};    // index in the plan of each side
  std::optional<History> history;
};

} // namespace kerf::coupler
