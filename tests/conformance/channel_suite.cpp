// What every transport has to keep: frames arrive whole, once and in order, and nobody waits
// without a bound. Each test runs over each transport, both ends in this process.
#include "coupler/channel/channel.hpp"
#include "coupler/channel/slot_queue.hpp"

#include <atomic>
#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <numeric>
#include <thread>
#include <unistd.h>
#include <vector>

namespace kerf::coupler {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

const Wait patient{.limit = 20s, .idle = {}};
const Wait brief{.limit = 30ms, .idle = {}};

/// Both ends of one link, opened as a broker and a participant do.
struct Link {
  Link(const std::string& transport, std::size_t up, std::size_t down) {
    ChannelAddress address{.transport = transport.substr(0, transport.find('_')),
                           .up_capacity = up,
                           .down_capacity = down};
    if (transport == "shm" || transport == "shm_path")
      address.descriptor = descriptor = create_segment();
    if (transport == "zmq_tcp")
      address.endpoint = "tcp://127.0.0.1:*";
    broker = open_broker_end(address);
    if (transport == "shm_path") // a participant that was not started by the launcher
      address.descriptor = -1;
    participant = open_participant_end(address);
  }
  ~Link() {
    if (descriptor >= 0)
      close(descriptor);
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  int descriptor = -1;
  std::unique_ptr<Channel> broker, participant;
};

void send_number(Channel& channel, std::uint64_t number, std::size_t bytes = 8) {
  const auto frame = channel.outgoing(patient);
  for (std::size_t at = 0; at + 8 <= bytes; at += 8)
    std::memcpy(frame.data() + at, &number, 8);
  channel.send(bytes);
}

std::uint64_t number_in(std::span<const std::byte> frame) {
  std::uint64_t number = 0;
  std::memcpy(&number, frame.data(), 8);
  return number;
}

std::uint64_t receive_number(Channel& channel) {
  return number_in(channel.receive(patient));
}

class EveryTransport : public testing::TestWithParam<const char*> {
protected:
  Link open(std::size_t up = 64, std::size_t down = 64) { return {GetParam(), up, down}; }
};

INSTANTIATE_TEST_SUITE_P(Channel, EveryTransport,
                         testing::Values("shm", "shm_path", "zmq", "zmq_tcp", "loopback"),
                         [](const auto& which) { return std::string(which.param); });

TEST_P(EveryTransport, delivers_frames_in_order_in_both_directions) {
  Link link = open();
  for (std::uint64_t n = 0; n < 100; ++n) {
    send_number(*link.participant, n);
    send_number(*link.broker, 1000 + n);
    ASSERT_EQ(receive_number(*link.broker), n);
    ASSERT_EQ(receive_number(*link.participant), 1000 + n);
  }
}

TEST_P(EveryTransport, delivers_frames_of_any_length_up_to_the_capacity) {
  Link link = open(100, 0);
  for (const std::size_t bytes : {100, 0, 1, 63, 64, 99}) {
    const auto frame = link.participant->outgoing(patient);
    ASSERT_EQ(frame.size(), 100u);
    std::memset(frame.data(), static_cast<int>(bytes), bytes);
    link.participant->send(bytes);
    const auto received = link.broker->receive(patient);
    ASSERT_EQ(received.size(), bytes);
    for (const std::byte byte : received)
      ASSERT_EQ(std::to_integer<std::size_t>(byte), bytes);
  }
  link.broker->send(0);
  EXPECT_TRUE(link.participant->receive(patient).empty());
}

TEST_P(EveryTransport, refuses_a_frame_beyond_the_capacity_and_goes_on) {
  Link link = open(64, 128);
  link.participant->outgoing(patient);
  EXPECT_THROW(link.participant->send(65), std::invalid_argument);
  EXPECT_THROW(link.broker->receive(brief), TimeoutError);
  send_number(*link.participant, 7, 64);
  EXPECT_EQ(receive_number(*link.broker), 7u);
}

TEST_P(EveryTransport, gives_aligned_memory_that_is_the_same_until_it_is_sent) {
  Link link = open(40, 40);
  for (Channel* end : {link.participant.get(), link.broker.get()})
    for (int n = 0; n < 2; ++n) {
      const auto frame = end->outgoing(patient);
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(frame.data()) % 64, 0u);
      EXPECT_EQ(end->outgoing(patient).data(), frame.data());
      end->send(8);
    }
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(link.broker->receive(patient).data()) % 64, 0u);
}

TEST_P(EveryTransport, has_room_for_two_frames_and_makes_the_third_wait_until_one_is_taken) {
  Link link = open();
  send_number(*link.participant, 1);
  send_number(*link.participant, 2);
  EXPECT_THROW(link.participant->outgoing(brief), TimeoutError);
  EXPECT_EQ(receive_number(*link.broker), 1u);
  EXPECT_EQ(receive_number(*link.broker), 2u); // and with it gives the first one back
  send_number(*link.participant, 3);
  EXPECT_EQ(receive_number(*link.broker), 3u);
}

// One slot per direction would deadlock here: both sides send twice before either receives.
TEST_P(EveryTransport, lets_both_sides_send_before_either_receives) {
  Link link = open();
  for (std::uint64_t round = 0; round < 10; ++round) {
    for (Channel* end : {link.participant.get(), link.broker.get()})
      for (std::uint64_t n = 0; n < 2; ++n)
        send_number(*end, 2 * round + n);
    for (Channel* end : {link.participant.get(), link.broker.get()})
      for (std::uint64_t n = 0; n < 2; ++n)
        ASSERT_EQ(receive_number(*end), 2 * round + n);
    // Gives the last frames back, and so makes room for the next round.
    EXPECT_THROW(link.broker->receive({.limit = 1ms, .idle = {}}), TimeoutError);
    EXPECT_THROW(link.participant->receive({.limit = 1ms, .idle = {}}), TimeoutError);
  }
}

TEST_P(EveryTransport, keeps_a_received_frame_until_the_next_one_is_asked_for) {
  Link link = open();
  send_number(*link.participant, 11);
  const auto frame = link.broker->receive(patient);
  send_number(*link.participant, 12);
  try { // the memory channels have no room now; ZeroMQ keeps a copy
    std::memset(link.participant->outgoing(brief).data(), 0xff, 64);
  } catch (const TimeoutError&) {
  }
  EXPECT_EQ(number_in(frame), 11u);
  EXPECT_EQ(receive_number(*link.broker), 12u);
}

TEST_P(EveryTransport, gives_up_at_the_limit_and_not_before) {
  Link link = open();
  const auto start = Clock::now();
  EXPECT_THROW(link.broker->receive({.limit = 120ms, .idle = {}}), TimeoutError);
  const auto waited = Clock::now() - start;
  EXPECT_GE(waited, 120ms);
  EXPECT_LT(waited, 1s);
}

TEST_P(EveryTransport, calls_idle_about_every_50_ms_while_it_waits) {
  Link link = open();
  int calls = 0;
  EXPECT_THROW(link.broker->receive({.limit = 500ms, .idle = [&] { ++calls; }}), TimeoutError);
  EXPECT_GE(calls, 3); // a busy machine may be late
  EXPECT_LE(calls, 10);
}

TEST_P(EveryTransport, does_not_call_idle_when_the_frame_is_there) {
  Link link = open();
  int calls = 0;
  const Wait wait{.limit = 20s, .idle = [&] { ++calls; }};
  for (std::uint64_t n = 0; n < 100; ++n) {
    send_number(*link.participant, n);
    ASSERT_EQ(number_in(link.broker->receive(wait)), n);
  }
  EXPECT_EQ(calls, 0);
}

TEST_P(EveryTransport, lets_idle_end_a_wait_by_throwing_and_can_be_used_after_it) {
  struct PeerDied {};
  const Wait wait{.limit = 20s, .idle = [] { throw PeerDied(); }};
  Link link = open();
  EXPECT_THROW(link.broker->receive(wait), PeerDied);
  send_number(*link.participant, 1);
  send_number(*link.participant, 2);
  EXPECT_THROW(link.participant->outgoing(wait), PeerDied);
  EXPECT_EQ(receive_number(*link.broker), 1u);
}

// The receiver is asleep whenever the frame comes: 200 lost wake-ups would take 10 s in slices of
// 50 ms, and each would call idle.
TEST_P(EveryTransport, wakes_a_sleeping_receiver_at_once) {
  Link link = open();
  constexpr std::uint64_t rounds = 200;
  std::thread sender([&] {
    for (std::uint64_t n = 0; n < rounds; ++n) {
      std::this_thread::sleep_for(600us);
      send_number(*link.participant, n);
    }
  });
  int idle_calls = 0;
  const Wait wait{.limit = 20s, .idle = [&] { ++idle_calls; }};
  for (std::uint64_t n = 0; n < rounds; ++n)
    EXPECT_EQ(number_in(link.broker->receive(wait)), n);
  sender.join();
  EXPECT_LT(idle_calls, 5); // none but for a machine that stood still
}

// Both sides send frames of changing length filled with their number, as fast as they can. A torn
// or repeated frame shows as a number that is not the expected one.
TEST_P(EveryTransport, tears_none_of_100000_frames) {
  constexpr std::uint64_t frames = 50'000; // in each direction
  constexpr std::size_t capacity = 512;
  Link link = open(capacity, capacity);
  const auto length = [](std::uint64_t n) { return 8 + 8 * (n * 7 % 64); };
  const auto run = [&](Channel& end, std::uint64_t mine, std::uint64_t others) {
    std::uint64_t wrong = 0;
    for (std::uint64_t n = 0; n < frames; ++n) {
      send_number(end, mine + n, length(n));
      const auto frame = end.receive(patient);
      wrong += frame.size() != length(n);
      for (std::size_t at = 0; at + 8 <= frame.size(); at += 8)
        wrong += number_in(frame.subspan(at)) != others + n;
    }
    return wrong;
  };
  std::uint64_t wrong_up = 0, wrong_down = 0;
  std::thread participant([&] { wrong_down = run(*link.participant, 0, 1'000'000); });
  wrong_up = run(*link.broker, 1'000'000, 0);
  participant.join();
  EXPECT_EQ(wrong_up, 0u);
  EXPECT_EQ(wrong_down, 0u);
}

// A stream in one direction fills both slots again and again, so that the sender sleeps too.
TEST_P(EveryTransport, streams_frames_past_a_slow_receiver) {
  Link link = open();
  constexpr std::uint64_t frames = 2'000;
  std::thread sender([&] {
    for (std::uint64_t n = 0; n < frames; ++n)
      send_number(*link.participant, n);
  });
  for (std::uint64_t n = 0; n < frames; ++n) {
    if (n % 20 == 0)
      std::this_thread::sleep_for(300us);
    ASSERT_EQ(receive_number(*link.broker), n);
  }
  sender.join();
}

TEST(Channel, refuses_an_unknown_transport) {
  ChannelAddress address{.transport = "pigeon"};
  EXPECT_THROW(open_broker_end(address), std::invalid_argument);
  EXPECT_THROW(open_participant_end(address), std::invalid_argument);
}

TEST(Channel, refuses_capacities_that_no_machine_has) {
  for (const char* transport : {"shm", "zmq", "loopback"}) {
    ChannelAddress address{.transport = transport, .up_capacity = std::size_t{1} << 62};
    EXPECT_ANY_THROW(open_broker_end(address)) << transport;
  }
}

TEST(Loopback, needs_a_link_that_waits_under_its_name) {
  ChannelAddress address{
      .transport = "loopback", .endpoint = "nobody", .up_capacity = 64, .down_capacity = 64};
  EXPECT_THROW(open_participant_end(address), std::invalid_argument);
  auto broker = open_broker_end(address);
  EXPECT_THROW(open_broker_end(address), std::invalid_argument); // the name is taken
  auto participant = open_participant_end(address);
  EXPECT_THROW(open_participant_end(address), std::invalid_argument); // somebody came already
}

} // namespace
} // namespace kerf::coupler
