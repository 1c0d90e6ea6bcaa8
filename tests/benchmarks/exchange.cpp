#include "tests/benchmarks/exchange.hpp"

#include "coupler/broker/coupling.hpp"
#include "coupler/channel/channel.hpp"
#include "coupler/channel/frame_layout.hpp"
#include "tests/benchmarks/statistics.hpp"

#include <fmt/format.h>
#include <linux/futex.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

namespace kerf::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;
using coupler::Channel, coupler::FrameKind, coupler::FrameLayout;

double microseconds_per_step(Clock::time_point start, int steps) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count() / steps;
}

/// Runs two participants as children and the broker here; gives the broker's value.
double three_processes(const std::function<void(int which)>& participant,
                       const std::function<double()>& broker) {
  std::array<pid_t, 2> children{};
  for (int which = 0; which < 2; ++which) {
    children[which] = fork();
    if (children[which] == 0) {
      participant(which);
      _exit(0);
    }
  }
  const double value = broker();
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0)
      throw std::runtime_error("a participant of the benchmark failed");
  }
  return value;
}

// ---- the bare limit: two counters a participant, no frames, no data
// ------------------------------

struct alignas(64) Counter {
  std::atomic<std::uint32_t> value{0};
};

/// The wait rule of the shared memory channel: yield for 100 µs, then sleep on a futex.
void wait_for(Counter& counter, std::uint32_t value) {
  const auto start = Clock::now();
  while (counter.value.load(std::memory_order_acquire) != value)
    if (Clock::now() - start < std::chrono::microseconds(100)) {
      sched_yield();
    } else {
      const std::uint32_t seen = counter.value.load();
      const timespec slice{0, 1'000'000};
      if (seen != value)
        syscall(SYS_futex, &counter.value, FUTEX_WAIT, seen, &slice, nullptr, 0);
    }
}

double bare_limit(int steps) {
  void* memory =
      mmap(nullptr, 4 * sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* counter = new (memory) Counter[4]; // up 0, up 1, down 0, down 1
  const auto bump = [](Counter& c, int n) {
    c.value.store(static_cast<std::uint32_t>(n), std::memory_order_release);
    syscall(SYS_futex, &c.value, FUTEX_WAKE, 1, nullptr, nullptr, 0);
  };
  const double value = three_processes(
      [&](int which) {
        for (int n = 1; n <= steps; ++n) {
          bump(counter[which], n);
          wait_for(counter[2 + which], static_cast<std::uint32_t>(n));
        }
      },
      [&] {
        const auto start = Clock::now();
        for (int n = 1; n <= steps; ++n) {
          wait_for(counter[0], static_cast<std::uint32_t>(n));
          wait_for(counter[1], static_cast<std::uint32_t>(n));
          bump(counter[2], n);
          bump(counter[3], n);
        }
        return microseconds_per_step(start, steps);
      });
  munmap(memory, 4 * sizeof(Counter));
  return value;
}

// ---- kerf's channels
// ------------------------------------------------------------------------------

/// Particles in a block of hexahedra, one in each of the first elements.
struct Model {
  coupler::Declaration particles, mesh;
  std::unique_ptr<coupler::Coupling> coupling;
  std::array<FrameLayout, 2> layout;

  explicit Model(int points) {
    const int n = static_cast<int>(std::ceil(std::cbrt(points)));
    const int m = n + 1;
    particles.dimension = mesh.dimension = 3;
    for (int k = 0; k < points; ++k) {
      const int at[3] = {k % n, k / n % n, k / n / n};
      for (const int x : at)
        particles.positions.push_back(x + 0.4);
      particles.ids.push_back(k);
      particles.radii.push_back(0.5);
      particles.stiffness.push_back(1.0);
    }
    for (int k = 0; k < m * m * m; ++k) {
      mesh.ids.push_back(k);
      for (const int x : {k % m, k / m % m, k / m / m})
        mesh.positions.push_back(x);
    }
    mesh.nodes_per_element = 8;
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          for (const auto& [i, j, l] : std::array<std::array<int, 3>, 8>{{{0, 0, 0},
                                                                          {1, 0, 0},
                                                                          {1, 1, 0},
                                                                          {0, 1, 0},
                                                                          {0, 0, 1},
                                                                          {1, 0, 1},
                                                                          {1, 1, 1},
                                                                          {0, 1, 1}}})
            mesh.elements.push_back(static_cast<std::uint32_t>(((z + l) * m + y + j) * m + x + i));
    std::vector<std::uint32_t>& left = mesh.boundary["left"];
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (const auto& [j, l] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
          left.push_back(static_cast<std::uint32_t>((z + l) * m * m + (y + j) * m));
    coupling = coupler::make_overlap(
        {.name = "joint", .boundary = "left", .width = 1.0 * n, .lagrange = false}, particles,
        mesh);
    for (int side = 0; side < 2; ++side) {
      const coupler::Declaration& body = side == 0 ? particles : mesh;
      coupler::Interface interface;
      interface.coupling = "joint";
      interface.points = coupling->side(side).points;
      layout[side] = FrameLayout(3, body.ids, std::array{interface});
    }
    const std::size_t np = coupling->side(0).points.size(), nn = coupling->side(1).points.size();
    const std::vector<double> mass_p(3 * np, 1.0), mass_n(3 * nn, 1.0), none_p(np, 0.0),
        none_n(nn, 0.0);
    coupling->coupled_omega2({mass_p, none_p}, {mass_n, none_n});
    coupling->start(1e-3);
  }
};

/// @param work  computes the penalty and its books, and lets the participants write their motion
double channel_step(Model& model, const std::string& transport, bool work, int steps) {
  std::array<coupler::ChannelAddress, 2> address;
  std::array<std::unique_ptr<Channel>, 2> channel;
  for (int side = 0; side < 2; ++side) {
    address[side].transport = transport;
    address[side].up_capacity = model.layout[side].up_capacity();
    address[side].down_capacity = model.layout[side].down_capacity();
    if (transport == "shm")
      address[side].descriptor = coupler::create_segment();
    else
      address[side].endpoint = fmt::format("ipc://@kerf-bench-{}-{}-{}", getpid(), side, steps);
  }
  const coupler::Wait wait{.limit = std::chrono::seconds(20), .idle = {}};
  if (transport == "shm") // before the fork: the children inherit the descriptor
    for (int side = 0; side < 2; ++side)
      channel[side] = coupler::open_broker_end(address[side]);
  const double value = three_processes(
      [&](int side) {
        const FrameLayout& layout = model.layout[side];
        const auto end = coupler::open_participant_end(address[side]);
        const std::vector<double>& rest =
            side == 0 ? model.particles.positions : model.mesh.positions;
        for (int n = 0; n < steps; ++n) {
          const auto frame = end->outgoing(wait);
          layout.write_header(frame, FrameKind::motion, static_cast<std::uint64_t>(n));
          if (work) {
            const auto x = layout.values(frame, FrameKind::motion, 0, coupler::Field::position);
            const auto& points = model.coupling->side(side).points;
            for (std::size_t k = 0; k < points.size(); ++k)
              for (std::size_t c = 0; c < 3; ++c)
                x[3 * k + c] = rest[3 * points[k] + c] + 1e-6 * n;
          }
          end->send(layout.bytes(FrameKind::motion));
          coupler::check_frame(end->receive(wait), FrameKind::interface_forces,
                               static_cast<std::uint64_t>(n), layout);
        }
      },
      [&] {
        if (transport != "shm")
          for (int side = 0; side < 2; ++side)
            channel[side] = coupler::open_broker_end(address[side]);
        Clock::time_point start;
        const int warm_up = steps / 10;
        for (int n = 0; n < steps; ++n) {
          if (n == warm_up)
            start = Clock::now();
          std::array<std::span<const std::byte>, 2> motion;
          std::array<std::span<std::byte>, 2> forces;
          for (int side = 0; side < 2; ++side) {
            motion[side] = channel[side]->receive(wait);
            coupler::check_frame(motion[side], FrameKind::motion, static_cast<std::uint64_t>(n),
                                 model.layout[side]);
            forces[side] = channel[side]->outgoing(wait);
            model.layout[side].write_header(forces[side], FrameKind::interface_forces,
                                            static_cast<std::uint64_t>(n));
          }
          const auto of = [&](int side, coupler::Field field) {
            return model.layout[side].values(motion[side], FrameKind::motion, 0, field);
          };
          const auto force = [&](int side) {
            return model.layout[side].values(forces[side], FrameKind::interface_forces, 0,
                                             coupler::Field::force);
          };
          const auto state = [&](int side) {
            return coupler::Coupling::Motion{
                of(side, coupler::Field::position), of(side, coupler::Field::velocity), {}};
          };
          const auto step = static_cast<std::uint64_t>(n);
          if (work)
            model.coupling->compute(step, state(0), state(1), force(0), force(1));
          for (int side = 0; side < 2; ++side)
            channel[side]->send(model.layout[side].bytes(FrameKind::interface_forces));
          if (work)
            model.coupling->enter_books(step, state(0), state(1), force(0), force(1));
        }
        return microseconds_per_step(start, steps - warm_up);
      });
  if (transport == "shm")
    for (int side = 0; side < 2; ++side)
      close(address[side].descriptor);
  return value;
}

} // namespace

nlohmann::json exchange(int points, int rounds) {
  Model model(points);
  std::map<std::string, std::vector<double>> times;
  for (int round = 0; round < rounds; ++round) { // in turn, so that drift of the machine cancels
    times["limit"].push_back(bare_limit(20'000));
    times["kerf"].push_back(channel_step(model, "shm", false, 20'000));
    times["kerf with penalty"].push_back(channel_step(model, "shm", true, 20'000));
    times["zmq"].push_back(channel_step(model, "zmq", false, 4'000));
  }
  fmt::print("{} points x 3 doubles both ways, two participants and a broker, {} rounds in turn\n",
             points, rounds);
  fmt::print("{:<20} {:>10} {:>10} {:>10} {:>10}\n", "µs per step", "median", "least", "most",
             "/ limit");
  nlohmann::json figures;
  for (const char* code : {"limit", "kerf", "kerf with penalty", "zmq"}) {
    const auto& t = times[code];
    fmt::print("{:<20} {:>10.2f} {:>10.2f} {:>10.2f} {:>10.2f}\n", code, median(t),
               *std::ranges::min_element(t), *std::ranges::max_element(t),
               median(t) / median(times["limit"]));
    figures[code] = median(t);
  }
  fmt::print("the penalty of {} points adds {:.2f} µs\n", points,
             median(times["kerf with penalty"]) - median(times["kerf"]));
  return {{fmt::format("exchange_{}", points), {{"1", figures}}}};
}

} // namespace kerf::benchmarks
