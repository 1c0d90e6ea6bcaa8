// Shared memory between processes, and memory that a participant must not believe.
#include "coupler/channel/channel.hpp"
#include "coupler/channel/memory_channel.hpp"
#include "coupler/protocol/protocol_error.hpp"

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf::coupler {
namespace {

using namespace std::chrono_literals;

const Wait patient{.limit = 20s, .idle = {}};
constexpr std::size_t capacity = 4096; // bytes

struct Segment {
  Segment() {
    address.transport = "shm";
    address.descriptor = create_segment();
    address.up_capacity = address.down_capacity = capacity;
  }
  ~Segment() { close(address.descriptor); }
  Segment(const Segment&) = delete;
  Segment& operator=(const Segment&) = delete;
  ChannelAddress address;
};

/// Runs a participant that gives every frame back; returns its process.
pid_t fork_echo(const ChannelAddress& address, int frames) {
  const pid_t child = fork();
  if (child != 0)
    return child;
  try {
    const auto channel = open_participant_end(address);
    for (int n = 0; n < frames; ++n) {
      const auto frame = channel->receive(patient);
      std::memcpy(channel->outgoing(patient).data(), frame.data(), frame.size());
      channel->send(frame.size());
    }
    _exit(0);
  } catch (...) {
    _exit(1);
  }
}

void exchange(Channel& channel, int frames) {
  for (int n = 0; n < frames; ++n) {
    std::memset(channel.outgoing(patient).data(), n % 251, capacity);
    channel.send(capacity);
    const auto frame = channel.receive(patient);
    ASSERT_EQ(frame.size(), capacity);
    for (const std::byte byte : frame)
      ASSERT_EQ(std::to_integer<int>(byte), n % 251);
  }
}

TEST(SharedMemory, carries_frames_between_processes) {
  for (const bool inherited : {true, false}) {
    Segment segment;
    const auto channel = open_broker_end(segment.address);
    ChannelAddress address = segment.address;
    if (!inherited)
      address.descriptor = -1; // opens /proc/<pid>/fd/<n>
    const pid_t child = fork_echo(address, 2000);
    exchange(*channel, 2000);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
}

TEST(SharedMemory, lets_the_broker_time_out_when_the_participant_was_killed) {
  Segment segment;
  const auto channel = open_broker_end(segment.address);
  const pid_t child = fork_echo(segment.address, 1'000'000);
  exchange(*channel, 10);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_THROW(channel->receive({.limit = 100ms, .idle = {}}), TimeoutError);
}

TEST(SharedMemory, has_a_sealed_size) {
  Segment segment;
  const auto channel = open_broker_end(segment.address);
  EXPECT_NE(ftruncate(segment.address.descriptor, 0), 0);
  EXPECT_NE(ftruncate(segment.address.descriptor, 1 << 20), 0);
}

TEST(SharedMemory, is_refused_when_it_is_not_what_the_broker_announced) {
  Segment segment;
  EXPECT_THROW(open_participant_end(segment.address), std::invalid_argument); // not sealed
  const auto channel = open_broker_end(segment.address);

  ChannelAddress other = segment.address;
  other.up_capacity += 4096; // another size
  EXPECT_THROW(open_participant_end(other), std::invalid_argument);

  other = segment.address;
  other.up_capacity += 4096; // the same size, but the header says otherwise
  other.down_capacity -= 4096;
  EXPECT_THROW(open_participant_end(other), std::invalid_argument);

  other.descriptor = -1;
  other.endpoint = "/dev/null"; // no memory file
  EXPECT_THROW(open_participant_end(other), std::invalid_argument);
  other.endpoint = "/proc/self/fd/9999";
  EXPECT_THROW(open_participant_end(other), std::invalid_argument);
}

TEST(SharedMemory, is_refused_when_its_header_is_not_ours) {
  Segment segment;
  const std::size_t bytes = segment_bytes(capacity, capacity);
  ASSERT_EQ(ftruncate(segment.address.descriptor, static_cast<off_t>(bytes)), 0);
  ASSERT_EQ(
      fcntl(segment.address.descriptor, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL), 0);
  EXPECT_THROW(open_participant_end(segment.address), std::invalid_argument);
}

/// The broker's side of a segment that a test can damage.
class Damaged : public testing::Test {
protected:
  Damaged() {
    channel_ = open_broker_end(segment_.address);
    const std::size_t bytes = segment_bytes(capacity, capacity);
    memory_ = static_cast<std::byte*>(
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, segment_.address.descriptor, 0));
    up_ = reinterpret_cast<SlotControl*>(memory_ + sizeof(SegmentHeader));
    down_ = reinterpret_cast<SlotControl*>(memory_ + sizeof(SegmentHeader) +
                                           slot_queue_bytes(capacity));
  }
  ~Damaged() override { munmap(memory_, segment_bytes(capacity, capacity)); }

  Segment segment_;
  std::unique_ptr<Channel> channel_;
  std::byte* memory_ = nullptr;
  SlotControl* up_ = nullptr;
  SlotControl* down_ = nullptr;
};

TEST_F(Damaged, length_of_a_frame_is_not_believed) {
  up_->length.bytes[0] = capacity + 1;
  up_->sent.value = 1;
  EXPECT_THROW(channel_->receive(patient), ProtocolError);
}

TEST_F(Damaged, counter_of_the_sender_is_not_believed) {
  up_->sent.value = 3;
  EXPECT_THROW(channel_->receive(patient), ProtocolError);
}

TEST_F(Damaged, counter_of_the_receiver_is_not_believed) {
  down_->taken.value = 1; // although nothing was sent
  EXPECT_THROW(channel_->outgoing(patient), ProtocolError);
}

} // namespace
} // namespace kerf::coupler
