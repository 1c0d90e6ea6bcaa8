// Frames: where each field stands, and which frames are refused.
#include "coupler/channel/frame_layout.hpp"

#include <cstring>
#include <gtest/gtest.h>

namespace kerf::coupler {
namespace {

const std::vector<std::int64_t> ids = {100, 101, 102, 103};

std::vector<Interface> interfaces() {
  return {{"one", {0, 2, 3}, {}}, {"two", {1}, {}}};
}

/// Frame memory as a channel gives it.
struct Memory {
  alignas(64) std::byte bytes[1024] = {};
};

// Three points and one, in the plane: position, velocity of "one", then of "two".
TEST(FrameLayout, puts_interface_after_interface_and_field_after_field) {
  const FrameLayout layout(2, ids, interfaces());
  EXPECT_EQ(layout.num_interfaces(), 2u);
  EXPECT_EQ(layout.count(FrameKind::motion), 16u);
  EXPECT_EQ(layout.count(FrameKind::own_forces), 8u);
  EXPECT_EQ(layout.bytes(FrameKind::interface_forces), 64u + 64u);
  EXPECT_EQ(layout.up_capacity(), 64u + 128u);
  EXPECT_EQ(layout.down_capacity(), 128u);

  Memory memory;
  const auto start = reinterpret_cast<double*>(memory.bytes + 64);
  const std::span<std::byte> frame = memory.bytes;
  const auto at = [&](std::size_t i, Field field) {
    const auto values = layout.values(frame, FrameKind::motion, i, field);
    return std::pair(values.data() - start, values.size());
  };
  EXPECT_EQ(at(0, Field::position), std::pair(0l, 6ul));
  EXPECT_EQ(at(0, Field::velocity), std::pair(6l, 6ul));
  EXPECT_EQ(at(1, Field::position), std::pair(12l, 2ul));
  EXPECT_EQ(at(1, Field::velocity), std::pair(14l, 2ul));
  EXPECT_EQ(layout.values(frame, FrameKind::interface_forces, 1, Field::force).data(), start + 6);
}

TEST(FrameLayout, gives_a_rotation_one_component_in_the_plane_and_three_in_space) {
  const std::vector<Interface> rotating = {
      {"one", {0, 1}, {}, {Field::position, Field::angular_velocity}, {Field::moment}}};
  EXPECT_EQ(FrameLayout(2, ids, rotating).count(FrameKind::motion), 2u * (2 + 1));
  EXPECT_EQ(FrameLayout(3, ids, rotating).count(FrameKind::motion), 2u * (3 + 3));
  EXPECT_EQ(FrameLayout(2, ids, rotating).count(FrameKind::interface_forces), 2u);
}

TEST(FrameLayout, has_a_checksum_that_any_difference_changes) {
  const auto sum = FrameLayout(2, ids, interfaces()).checksum();
  EXPECT_EQ(sum, FrameLayout(2, ids, interfaces()).checksum());
  EXPECT_NE(sum, FrameLayout(3, ids, interfaces()).checksum());
  const auto other_id = std::vector<std::int64_t>{100, 101, 102, 104};
  EXPECT_NE(sum, FrameLayout(2, other_id, interfaces()).checksum());
  auto changed = interfaces();
  changed[0].coupling = "uno";
  EXPECT_NE(sum, FrameLayout(2, ids, changed).checksum());
  changed = interfaces();
  changed[0].points = {0, 2};
  EXPECT_NE(sum, FrameLayout(2, ids, changed).checksum());
  changed = interfaces();
  changed[0].motion = {Field::velocity, Field::position};
  EXPECT_NE(sum, FrameLayout(2, ids, changed).checksum());
}

TEST(FrameLayout, refuses_what_it_cannot_place) {
  EXPECT_THROW(FrameLayout(2, std::vector<std::int64_t>{1}, interfaces()), std::invalid_argument);
  const std::vector<Interface> twice = {{"one", {0}, {}, {Field::position, Field::position}, {}}};
  EXPECT_THROW(FrameLayout(2, ids, twice), std::invalid_argument);
  const FrameLayout layout(2, ids, interfaces());
  Memory memory;
  const std::span<std::byte> frame = memory.bytes;
  EXPECT_THROW(layout.values(frame, FrameKind::motion, 2, Field::position), std::out_of_range);
  EXPECT_THROW(layout.values(frame, FrameKind::motion, 0, Field::force), std::invalid_argument);
  EXPECT_THROW(layout.values(frame.first(100), FrameKind::motion, 0, Field::position),
               std::invalid_argument);
  EXPECT_THROW(layout.write_header(frame.first(100), FrameKind::motion, 0), std::invalid_argument);
}

TEST(Frame, is_refused_by_name_when_it_is_not_the_expected_one) {
  const FrameLayout layout(2, ids, interfaces());
  Memory memory;
  const std::size_t bytes = layout.bytes(FrameKind::motion);
  const std::span<std::byte> frame = std::span(memory.bytes).first(bytes);
  const auto refusal = [&](auto change, std::size_t size) -> std::string {
    layout.write_header(frame, FrameKind::motion, 7);
    FrameHeader header;
    std::memcpy(&header, frame.data(), sizeof header);
    change(header);
    std::memcpy(frame.data(), &header, sizeof header);
    try {
      check_frame(frame.first(size), FrameKind::motion, 7, layout);
    } catch (const ProtocolError& error) {
      return error.what();
    }
    return "";
  };
  const auto as_it_is = [](FrameHeader&) {};
  EXPECT_EQ(refusal(as_it_is, bytes), "");
  EXPECT_NE(refusal(as_it_is, bytes - 8), "");
  EXPECT_NE(refusal(as_it_is, 63), "");
  EXPECT_NE(refusal(as_it_is, 0), "");
  EXPECT_NE(refusal([](auto& h) { h.magic = 1; }, bytes), "");
  EXPECT_NE(refusal([](auto& h) { h.epoch = 1; }, bytes), "");
  EXPECT_NE(refusal([](auto& h) { h.count = 15; }, bytes), "");
  EXPECT_NE(refusal([](auto& h) { h.layout ^= 1; }, bytes), "");
  EXPECT_EQ(refusal([](auto& h) { h.step = 8; }, bytes),
            "the frame of motion at step 7 has the step 8, not 7");
  EXPECT_EQ(refusal([](auto& h) { h.version = 2; }, bytes),
            "the frame of motion at step 7 has the protocol version 2, not 1");
  EXPECT_EQ(refusal([](auto& h) { h.kind = FrameKind::own_forces; }, bytes),
            "a frame of own forces came at step 7 instead of motion");
}

TEST(Field, is_found_by_its_name) {
  for (const Field field : all_fields)
    EXPECT_EQ(field_of_name(name(field)), field);
  EXPECT_FALSE(field_of_name("colour"));
}

} // namespace
} // namespace kerf::coupler
