// See frame_layout.hpp.
#include "coupler/channel/frame_layout.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <stdexcept>

namespace kerf::coupler {
namespace {

std::string_view name(FrameKind kind) {
  switch (kind) {
  case FrameKind::motion:
    return "motion";
  case FrameKind::own_forces:
    return "own forces";
  case FrameKind::interface_forces:
    return "interface forces";
  }
  return "unknown";
}

/// Continues a checksum over a text and its end.
std::uint64_t add_text(std::uint64_t sum, std::string_view text) {
  return checksum(std::string_view("\0", 1), checksum(text, sum));
}

} // namespace

FrameLayout::FrameLayout(int dimension, std::span<const std::int64_t> ids,
                         std::span<const Interface> interfaces) {
  checksum_ = add_text(coupler::checksum({}), fmt::format("{}", dimension));
  const auto add = [&](const std::vector<Field>& fields, std::size_t n, Blocks& blocks,
                       std::size_t& count) {
    auto& row = blocks.emplace_back();
    for (const Field field : fields) {
      const auto same = [field](const Block& block) { return block.field == field; };
      if (std::any_of(row.begin(), row.end(), same))
        throw std::invalid_argument(
            fmt::format("the field {} stands twice in an interface", coupler::name(field)));
      row.push_back({field, count, n * components(field, dimension)});
      count += row.back().size;
      checksum_ = add_text(checksum_, coupler::name(field));
    }
    checksum_ = add_text(checksum_, "");
  };
  for (const Interface& interface : interfaces) {
    checksum_ = add_text(checksum_, interface.coupling);
    add(interface.motion, interface.points.size(), motion_, motion_count_);
    add(interface.forces, interface.points.size(), forces_, forces_count_);
    for (const std::uint32_t point : interface.points) {
      if (point >= ids.size())
        throw std::invalid_argument(
            fmt::format("point {} of \"{}\": there are {}", point, interface.coupling, ids.size()));
      checksum_ = add_text(checksum_, fmt::format("{}", ids[point]));
    }
  }
}

std::size_t FrameLayout::count(FrameKind kind) const noexcept {
  return kind == FrameKind::motion ? motion_count_ : forces_count_;
}

std::size_t FrameLayout::bytes(FrameKind kind) const noexcept {
  return sizeof(FrameHeader) + count(kind) * sizeof(double);
}

std::size_t FrameLayout::up_capacity() const noexcept {
  return std::max(bytes(FrameKind::motion), bytes(FrameKind::own_forces));
}

std::size_t FrameLayout::down_capacity() const noexcept {
  return bytes(FrameKind::interface_forces);
}

const FrameLayout::Block& FrameLayout::find(FrameKind kind, std::size_t interface,
                                            Field field) const {
  const Blocks& blocks = kind == FrameKind::motion ? motion_ : forces_;
  for (const Block& block : blocks.at(interface))
    if (block.field == field)
      return block;
  throw std::invalid_argument(fmt::format("interface {} has no {} in its frames of {}", interface,
                                          coupler::name(field), name(kind)));
}

std::span<const double> FrameLayout::values(std::span<const std::byte> frame, FrameKind kind,
                                            std::size_t interface, Field field) const {
  const Block& block = find(kind, interface, field);
  if (frame.size() < bytes(kind))
    throw std::invalid_argument(
        fmt::format("a frame of {} has {} bytes, not {}", name(kind), bytes(kind), frame.size()));
  const auto* first = reinterpret_cast<const double*>(frame.data() + sizeof(FrameHeader));
  return {first + block.offset, block.size};
}

std::span<double> FrameLayout::values(std::span<std::byte> frame, FrameKind kind,
                                      std::size_t interface, Field field) const {
  const auto found = values(std::span<const std::byte>(frame), kind, interface, field);
  return {const_cast<double*>(found.data()), found.size()}; // the frame itself is not const
}

void FrameLayout::write_header(std::span<std::byte> frame, FrameKind kind, std::uint64_t step,
                               std::uint32_t epoch) const {
  if (frame.size() < bytes(kind))
    throw std::invalid_argument(
        fmt::format("a frame of {} has {} bytes, not {}", name(kind), bytes(kind), frame.size()));
  FrameHeader header;
  header.kind = kind;
  header.epoch = epoch;
  header.step = step;
  header.count = count(kind);
  header.layout = checksum_;
  std::memcpy(frame.data(), &header, sizeof header);
}

void check_frame(std::span<const std::byte> frame, FrameKind kind, std::uint64_t step,
                 const FrameLayout& layout, std::uint32_t epoch) {
  const auto expect = [&](const char* what, std::uint64_t found, std::uint64_t agreed) {
    if (found != agreed)
      throw ProtocolError(fmt::format("the frame of {} at step {} has {} {}, not {}", name(kind),
                                      step, what, found, agreed));
  };
  if (frame.size() < sizeof(FrameHeader))
    expect("a size in bytes of", frame.size(), layout.bytes(kind));
  FrameHeader header;
  std::memcpy(&header, frame.data(), sizeof header);
  expect("the magic number", header.magic, FrameHeader::magic_number);
  expect("the protocol version", header.version, protocol_version);
  if (header.kind != kind)
    throw ProtocolError(fmt::format("a frame of {} came at step {} instead of {}",
                                    name(header.kind), step, name(kind)));
  expect("the step", header.step, step);
  expect("the epoch", header.epoch, epoch);
  expect("the layout", header.layout, layout.checksum());
  expect("a number of values of", header.count, layout.count(kind));
  expect("a size in bytes of", frame.size(), layout.bytes(kind));
}

} // namespace kerf::coupler
