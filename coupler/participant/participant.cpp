// See participant.hpp: the handshake, the frames of the steps, the end.
#include "coupler/participant/participant.hpp"

#include "coupler/channel/frame_layout.hpp"
#include "coupler/participant/control_line.hpp"

#include <charconv>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace kerf::coupler {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto forever = std::chrono::hours(24 * 365); // the broker or the lifeline ends a wait

double seconds(Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

/// A descriptor that the launcher handed down, or -1.
int inherited_descriptor(const char* variable) {
  const char* text = std::getenv(variable);
  if (text == nullptr || *text == '\0')
    return -1;
  const std::string_view view = text;
  int descriptor = -1;
  const auto [end, error] = std::from_chars(view.data(), view.data() + view.size(), descriptor);
  if (error != std::errc{} || end != view.data() + view.size())
    throw std::invalid_argument(fmt::format("{} = \"{}\" is no descriptor", variable, view));
  return descriptor;
}

std::string variable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? "" : text;
}

} // namespace

struct Participant::State {
  explicit State(const Invitation& an_invitation)
      : invitation(an_invitation), control(an_invitation.endpoint, an_invitation.lifeline) {
    wait.limit = forever;
    wait.idle = [this] { control.attend(progress()); };
  }

  Progress progress() const { return {step, seconds(waiting)}; }
  void open_channel();
  void require(bool condition, const char* sentence) const;
  std::span<double> outgoing(FrameKind kind, std::size_t interface, Field field);
  void publish(FrameKind kind);

  Invitation invitation;
  ControlLine control;

  Assignment assignment;
  int dimension = 0;
  Plan plan;
  Schedule schedule;
  FrameLayout layout;
  std::unique_ptr<Channel> channel; // none without interfaces
  Wait wait;

  std::uint64_t step = 0;
  enum class Phase { joined, declared, ready, began, moved, published, received, over };
  Phase phase = Phase::joined;
  std::span<const std::byte> forces;         // the frame of this step
  std::vector<std::vector<double>> unwanted; // own forces that no method reads

  Clock::time_point loop_start;
  Clock::duration waiting{};
  Clock::duration exchange{};
};

// --- the handshake ------------------------------------------------------------------------------

Participant Participant::join(const std::string& program) {
  Invitation invitation;
  invitation.endpoint = variable("KERF_BROKER");
  if (invitation.endpoint.empty())
    throw std::invalid_argument("KERF_BROKER is not set: this program takes part in a run and is "
                                "started by \"kerf run\", or by hand with the address of a broker");
  invitation.name = variable("KERF_PARTICIPANT");
  invitation.token = variable("KERF_TOKEN");
  invitation.segment = inherited_descriptor("KERF_SEGMENT");
  invitation.lifeline = inherited_descriptor("KERF_LIFELINE");
  invitation.program = program;
  return Participant(invitation);
}

Participant::Participant(const Invitation& invitation)
    : state_(std::make_unique<State>(invitation)) {
  auto& s = *state_;
  s.control.send(to_message(Hello{.name = invitation.name,
                                  .token = invitation.token,
                                  .pid = getpid(),
                                  .program = invitation.program}));
  const Clock::duration limit = s.control.lifeline().watched()
                                    ? Clock::duration(forever)
                                    : Clock::duration(invitation.join_limit);
  s.assignment = from_message<Assignment>(s.control.await(message::assignment, limit));
  s.control.lifeline().set_broker(s.assignment.broker_pid);
}

Participant::~Participant() = default;
Participant::Participant(Participant&&) noexcept = default;
Participant& Participant::operator=(Participant&&) noexcept = default;

const Assignment& Participant::assignment() const {
  return state_->assignment;
}

const Plan& Participant::declare(const Declaration& declaration) {
  auto& s = *state_;
  s.require(s.phase == State::Phase::joined, "declare() was called a second time");
  if (const std::string fault = fault_in(declaration); !fault.empty())
    throw std::invalid_argument("declare(): " + fault);
  s.control.send(to_message(declaration));
  s.plan = from_message<Plan>(s.control.await(message::plan, forever));
  if (const std::string fault = fault_in(s.plan, declaration.num_points()); !fault.empty())
    throw ProtocolError("the broker's plan: " + fault);
  s.dimension = declaration.dimension;
  s.layout = FrameLayout(declaration.dimension, declaration.ids, s.plan.interfaces);
  for (const Interface& interface : s.plan.interfaces)
    s.unwanted.emplace_back(interface.points.size() * declaration.dimension);
  s.phase = State::Phase::declared;
  return s.plan;
}

const Schedule& Participant::initialize(const Limits& limits) {
  auto& s = *state_;
  s.require(s.phase == State::Phase::declared, "initialize() comes once, after declare()");
  if (const auto fault = fault_in(limits, s.plan, s.dimension); !fault.empty())
    throw std::invalid_argument("initialize(): " + fault);
  s.control.send(to_message(limits));
  s.schedule = from_message<Schedule>(s.control.await(message::schedule, forever));
  s.step = s.schedule.first_step;
  s.open_channel();
  s.phase = State::Phase::ready;
  return s.schedule;
}

void Participant::State::open_channel() {
  if (plan.interfaces.empty() || schedule.steps == 0)
    return;
  ChannelAddress address = schedule.channel;
  if (address.transport.empty())
    throw ProtocolError("the broker's schedule has steps and interfaces, but no channel");
  if (schedule.layout != layout.checksum() || address.up_capacity < layout.up_capacity() ||
      address.down_capacity < layout.down_capacity())
    throw ProtocolError(fmt::format(
        "the broker expects other frames: layout {:016x} of {} bytes up and {} down, here {:016x} "
        "of {} and {}",
        schedule.layout, address.up_capacity, address.down_capacity, layout.checksum(),
        layout.up_capacity(), layout.down_capacity()));
  address.descriptor = invitation.segment;
  if (invitation.segment >= 0)
    fcntl(invitation.segment, F_SETFD, FD_CLOEXEC);
  channel = open_participant_end(address);
}

// --- the steps ----------------------------------------------------------------------------------

void Participant::State::require(bool condition, const char* sentence) const {
  if (!condition)
    throw std::logic_error(fmt::format("{} (step {})", sentence, step));
}

bool Participant::has_next_step() {
  auto& s = *state_;
  using Phase = State::Phase;
  if (s.phase == Phase::over)
    return false;
  const auto now = Clock::now();
  if (s.phase == Phase::ready) {
    s.loop_start = now;
  } else {
    s.require(s.phase == Phase::received || (s.phase == Phase::began && !s.channel),
              "a step needs publish_motion(), publish_forces() and receive()");
    ++s.step;
    s.control.lifeline().set_step(s.step);
  }
  s.control.attend_sometimes(now, s.progress());
  s.phase = s.step < s.schedule.steps ? Phase::began : Phase::over;
  return s.phase == Phase::began;
}

std::uint64_t Participant::step() const {
  return state_->step;
}

double Participant::time() const {
  return static_cast<double>(state_->step) * state_->schedule.time_step;
}

bool Participant::checkpoint_is_due() const {
  const auto& s = *state_;
  const std::uint64_t every = s.schedule.checkpoint_every;
  const bool is_over = s.phase == State::Phase::over;
  return (s.control.wants_checkpoint() && s.step > 0) ||
         (every != 0 && s.step > s.schedule.first_step && (is_over || s.step % every == 0));
}

std::size_t Participant::stage() const {
  return stage_before(state_->step + 1);
}

std::uint64_t Participant::stage_begin() const {
  const std::size_t k = stage();
  return k == 0 ? 0 : state_->schedule.ends[k - 1];
}

std::size_t Participant::stage_before(std::uint64_t step) const {
  const std::vector<std::uint64_t>& ends = state_->schedule.ends;
  std::size_t k = 0;
  while (k + 1 < ends.size() && ends[k] < step)
    ++k;
  return k;
}

void Participant::report_condition(const std::string& name, double value) {
  auto& s = *state_;
  s.require(s.phase == State::Phase::received, "report_condition() comes after receive()");
  s.control.send(to_message(ConditionMet{s.step, name, value}));
  const auto ends = from_message<Ends>(s.control.await(message::ends, forever));
  if (ends.steps <= s.step)
    throw ProtocolError(fmt::format("the broker ends the run at step {}, before the one of now, {}",
                                    ends.steps, s.step));
  s.schedule.steps = ends.steps;
  s.schedule.ends = ends.ends;
}

std::filesystem::path Participant::checkpoint_file() const {
  return state_->assignment.run_folder / "checkpoints" / fmt::format("{:09}", step()) /
         (state_->assignment.name + ".h5");
}

std::filesystem::path Participant::restart_file() const {
  const std::filesystem::path& folder = state_->assignment.restart;
  return folder.empty() ? folder : folder / (state_->assignment.name + ".h5");
}

void Participant::report_checkpoint() {
  auto& s = *state_;
  s.require(s.phase == State::Phase::began || s.phase == State::Phase::over,
            "report_checkpoint() comes before publish_motion()");
  s.control.send(to_message(CheckpointReport{s.step}));
  if (s.control.wants_checkpoint())
    s.control.await_stop();
}

std::span<double> Participant::State::outgoing(FrameKind kind, std::size_t interface, Field field) {
  return layout.values(channel->outgoing(wait), kind, interface, field);
}

void Participant::State::publish(FrameKind kind) {
  const auto start = Clock::now();
  layout.write_header(channel->outgoing(wait), kind, step);
  try {
    channel->send(layout.bytes(kind));
  } catch (const ClosedError&) {
    control.await_stop();
  }
  exchange += Clock::now() - start;
}

std::span<double> Participant::position(std::size_t interface) {
  state_->require(state_->phase == State::Phase::began && state_->channel,
                  "position() is written before publish_motion()");
  return state_->outgoing(FrameKind::motion, interface, Field::position);
}

std::span<double> Participant::velocity(std::size_t interface) {
  state_->require(state_->phase == State::Phase::began && state_->channel,
                  "velocity() is written before publish_motion()");
  return state_->outgoing(FrameKind::motion, interface, Field::velocity);
}

void Participant::publish_motion() {
  auto& s = *state_;
  s.require(s.phase == State::Phase::began, "publish_motion() comes once, after has_next_step()");
  if (s.channel)
    s.publish(FrameKind::motion);
  s.phase = State::Phase::moved;
}

std::span<double> Participant::own_forces(std::size_t interface) {
  auto& s = *state_;
  s.require(s.phase == State::Phase::moved && s.channel,
            "own_forces() is written between publish_motion() and publish_forces()");
  if (!s.plan.needs_own_forces)
    return s.unwanted.at(interface);
  return s.outgoing(FrameKind::own_forces, interface, Field::force);
}

void Participant::publish_forces() {
  auto& s = *state_;
  s.require(s.phase == State::Phase::moved, "publish_forces() comes once, after publish_motion()");
  if (s.channel && s.plan.needs_own_forces)
    s.publish(FrameKind::own_forces);
  s.phase = State::Phase::published;
}

void Participant::receive() {
  auto& s = *state_;
  s.require(s.phase == State::Phase::published, "receive() comes once, after publish_forces()");
  if (s.channel) {
    const auto start = Clock::now();
    s.forces = s.channel->receive(s.wait);
    check_frame(s.forces, FrameKind::interface_forces, s.step, s.layout);
    s.waiting += Clock::now() - start;
  }
  s.phase = State::Phase::received;
}

std::span<const double> Participant::interface_forces(std::size_t interface) const {
  state_->require(state_->phase == State::Phase::received && state_->channel,
                  "interface_forces() can be read after receive()");
  return state_->layout.values(state_->forces, FrameKind::interface_forces, interface,
                               Field::force);
}

// --- the end ------------------------------------------------------------------------------------

void Participant::finalize(const std::string& summary) {
  auto& s = *state_;
  s.require(s.phase == State::Phase::over || s.phase == State::Phase::ready,
            "finalize() comes after has_next_step() has become false");
  Finished finished;
  finished.steps = s.step;
  finished.exchange_seconds = seconds(s.exchange);
  finished.waiting_seconds = seconds(s.waiting);
  if (s.phase == State::Phase::over)
    finished.compute_seconds = seconds(Clock::now() - s.loop_start - s.exchange - s.waiting);
  finished.summary = summary;
  s.control.send(to_message(finished));
  s.control.await(message::goodbye, forever);
}

void Participant::fail(ErrorKind kind, const std::string& key,
                       const std::string& sentence) noexcept {
  try {
    state_->control.send(to_message(ErrorReport{kind, key, sentence, state_->step}));
  } catch (...) { // the broker sees the process end
  }
}

} // namespace kerf::coupler
