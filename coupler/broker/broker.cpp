#include "coupler/broker/broker.hpp"

#include "coupler/broker/members.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace kerf::coupler {
namespace {

std::string random_token() {
  std::array<std::uint64_t, 2> bits{};
  if (getrandom(bits.data(), sizeof bits, 0) != sizeof bits)
    throw std::runtime_error("the system gave no random numbers");
  return fmt::format("{:016x}{:016x}", bits[0], bits[1]);
}

OverlapSettings overlap_settings(const nlohmann::json& coupling, const nlohmann::json& settings) {
  OverlapSettings overlap;
  overlap.name = coupling.at("name");
  overlap.boundary = coupling.at("boundary");
  overlap.width = coupling.at("width");
  overlap.lagrange = coupling.at("method") == "lagrange";
  overlap.stiffness_ratio = coupling.at("stiffness_ratio");
  overlap.uniform_stiffness = coupling.at("stiffness_profile") == "uniform";
  overlap.blending = coupling.at("blending");
  const nlohmann::json& periodic = settings.at("case").at("periodic");
  for (const char* axis : {"x", "y", "z"}) {
    const nlohmann::json& range = periodic.at(axis);
    overlap.period.push_back(range.is_null() ? 0.0
                                             : range[1].get<double>() - range[0].get<double>());
  }
  return overlap;
}

/// A tiny excess of the time over a multiple of the step does not earn a step of its own.
std::uint64_t steps_until(double time, double step, const std::string& key) {
  const double steps = std::max(1.0, std::ceil(time / step * (1.0 - 1e-12)));
  if (steps > 9e15)
    throw RunError(ErrorKind::bad_input, key,
                   fmt::format("{:g} steps of {:g} s are too many\nend earlier", steps, step));
  return static_cast<std::uint64_t>(steps);
}

/// Where the case has what a participant was told as its own.
std::string key_in_case(const std::string& participant, const std::string& key) {
  if (key.starts_with("stages["))
    return key;
  if (key.starts_with("stop["))
    return "case." + key;
  return fmt::format("participants.{}{}{}", participant, key.empty() ? "" : ".", key);
}

} // namespace

Broker::Broker(RunSetup setup, Supervisor& supervisor)
    : setup_(std::move(setup)), supervisor_(supervisor), token_(random_token()) {}

Broker::~Broker() = default;

nlohmann::json Broker::run() {
  try {
    invite();
    shake_hands();
    collect_declarations();
    make_couplings();
    collect_limits();
    choose_time_step();
    open_channels();
    if (!setup_.plan_only)
      step_loop();
    await_finish();
    say_goodbye();
  } catch (const ParticipantLost& loss) {
    const RunError error = last_words(loss);
    stop_all(error.what());
    throw error;
  } catch (const Interrupted& interrupted) {
    await_last_checkpoint();
    stop_all("it was interrupted by the user");
    throw Interrupted(interrupted.signal(), place(), last_checkpoint());
  } catch (const std::exception& error) {
    stop_all(error.what());
    throw;
  }
  return record();
}

void Broker::invite() {
  phase_ = "before the handshake";
  control_ = std::make_unique<ControlServer>(
      fmt::format("ipc://@kerf-{}-{}", getpid(), token_.substr(0, 16)));
  // From here on the members keep their places: references to them stay valid.
  for (const auto& [name, table] : setup_.settings.at("participants").items()) {
    Member& m = members_.emplace_back();
    m.name = name;
    m.kind = table.at("kind");
    m.segment = setup_.transport == "shm" ? create_segment() : -1;
  }
  for (Member& m : members_)
    supervisor_.start({.endpoint = control_->endpoint(),
                       .name = m.name,
                       .token = token_,
                       .segment = m.segment,
                       .program = {}});
}

void Broker::shake_hands() {
  phase_ = "during the handshake";
  const double limit = setup_.settings.at("case").at("handshake_limit");
  const auto deadline = Clock::now() + std::chrono::duration<double>(limit);
  while (std::ranges::any_of(members_, [](const Member& m) { return m.peer.empty(); })) {
    if (Clock::now() > deadline)
      for (const Member& m : members_)
        if (m.peer.empty())
          throw RunError(
              ErrorKind::failed, "",
              fmt::format("participant \"{}\" did not connect within {:g} s", m.name, limit));
    serve(std::chrono::milliseconds(50));
  }
  for (Member& m : members_) {
    nlohmann::json table = setup_.settings.at("participants").at(m.name);
    table["stages"] = setup_.settings.at("stages");
    table["stop"] = setup_.settings.at("case").at("stop");
    Assignment assignment;
    assignment.name = m.name;
    assignment.settings = table.dump();
    assignment.case_settings = setup_.settings.at("case").dump();
    assignment.run_folder = setup_.run_folder;
    assignment.plan_only = setup_.plan_only;
    assignment.broker_pid = getpid();
    if (setup_.restart)
      assignment.restart = setup_.restart->folder;
    tell(m, to_message(assignment));
  }
}

void Broker::greet(const std::string& peer, const Message& message) {
  const auto refuse = [&](const std::string& reason) {
    spdlog::warn("refused a connection: {}", reason);
    control_->send(peer, to_message(Stop{reason}));
  };
  Hello hello;
  try {
    hello = from_message<Hello>(message);
  } catch (const ProtocolError& error) {
    return refuse(error.what());
  }
  const auto known = std::ranges::find(members_, hello.name, &Member::name);
  if (hello.protocol != protocol_version)
    return refuse(fmt::format("\"{}\" speaks version {} of the protocol, this kerf version {}",
                              hello.name, hello.protocol, protocol_version));
  if (hello.token != token_)
    return refuse(fmt::format("\"{}\" does not hold the token of this run", hello.name));
  if (known == members_.end())
    return refuse(fmt::format("the case has no participant \"{}\"", hello.name));
  if (!known->peer.empty())
    return refuse(
        fmt::format("participant \"{}\" is connected already (pid {})", known->name, known->pid));
  known->peer = peer;
  known->pid = hello.pid;
  known->program = hello.program;
  known->heard = Clock::now();
  spdlog::info("{} joined: {}, pid {}", known->name, known->program, known->pid);
}

void Broker::collect(const char* type, const std::function<void(Member&, const Message&)>& take) {
  const double limit = setup_.settings.at("case").at("handshake_limit");
  const auto deadline = Clock::now() + std::chrono::duration<double>(limit);
  expected_ = type;
  take_ = take;
  for (Member& m : members_)
    m.answered = false;
  while (std::ranges::any_of(members_, [](const Member& m) { return !m.answered; })) {
    serve(std::chrono::milliseconds(50));
    if (Clock::now() > deadline)
      for (const Member& m : members_)
        if (!m.answered)
          throw RunError(ErrorKind::failed, "",
                         fmt::format("participant \"{}\" (pid {}) was silent for {:g} s {}; its "
                                     "{} was expected",
                                     m.name, m.pid, limit, phase_, type));
  }
  expected_ = "";
}

void Broker::collect_declarations() {
  phase_ = "while it built its model";
  const int dimension = setup_.settings.at("case").at("dimension");
  collect(message::declaration, [&](Member& m, const Message& message) {
    m.declaration = from_message<Declaration>(message);
    if (const std::string fault = fault_in(m.declaration); !fault.empty())
      throw ProtocolError(fault);
    if (m.declaration.dimension != dimension)
      throw ProtocolError(fmt::format("it declares {} dimensions, the case has {}",
                                      m.declaration.dimension, dimension));
  });
  require_checkpoints();
  require_stages();
}

void Broker::make_couplings() {
  phase_ = "while the couplings were made";
  const nlohmann::json& couplings = setup_.settings.at("couplings");
  for (std::size_t c = 0; c < couplings.size(); ++c) {
    const nlohmann::json& table = couplings[c];
    Joint& joint = joints_.emplace_back();
    joint.name = table.at("name");
    joint.side[0] = &member(table.at("between")[0].get<std::string>());
    joint.side[1] = &member(table.at("between")[1].get<std::string>());
    if (joint.side[0]->kind != "dem")
      std::swap(joint.side[0], joint.side[1]);
    try {
      joint.coupling = make_overlap(overlap_settings(table, setup_.settings),
                                    joint.side[0]->declaration, joint.side[1]->declaration);
    } catch (const CouplingError& error) {
      throw RunError(ErrorKind::bad_input, fmt::format("couplings[{}].{}", c, error.key()),
                     error.what());
    }
    for (int s = 0; s < 2; ++s) {
      Member& m = *joint.side[s];
      const Coupling::Side& side = joint.coupling->side(s);
      joint.interface[s] = m.plan.interfaces.size();
      m.plan.interfaces.push_back(
          {.coupling = joint.name, .points = side.points, .stiffness = side.stiffness});
      m.plan.needs_own_forces |= joint.coupling->needs_own_forces();
      if (m.plan.weights.empty())
        m.plan.weights = side.weights;
      else if (!side.weights.empty())
        for (std::size_t p = 0; p < side.weights.size(); ++p)
          m.plan.weights[p] = std::min(m.plan.weights[p], side.weights[p]);
    }
  }
  refuse_shared_points();
  for (Member& m : members_)
    tell(m, to_message(m.plan));
}

/// A multiplier must know every other force on its points; two couplings that meet there would
/// each have to know the other's.
void Broker::refuse_shared_points() const {
  for (const Member& m : members_) {
    if (!m.plan.needs_own_forces || m.plan.interfaces.size() < 2)
      continue;
    std::map<std::uint32_t, std::string> owner;
    for (const Interface& interface : m.plan.interfaces)
      for (const std::uint32_t point : interface.points)
        if (const auto [at, is_new] = owner.try_emplace(point, interface.coupling); !is_new)
          throw RunError(
              ErrorKind::bad_input, "couplings",
              fmt::format("couplings \"{}\" and \"{}\" share point {} of \"{}\"; with "
                          "Lagrange multipliers couplings must not touch one another\nmove them "
                          "apart or use penalties",
                          at->second, interface.coupling, m.declaration.ids[point], m.name));
  }
}

void Broker::collect_limits() {
  phase_ = "while the time step was chosen";
  const int dimension = setup_.settings.at("case").at("dimension");
  collect(message::limits, [&](Member& m, const Message& message) {
    m.limits = from_message<Limits>(message);
    if (const std::string fault = fault_in(m.limits, m.plan, dimension); !fault.empty())
      throw ProtocolError(fault);
  });
}

void Broker::choose_time_step() {
  double largest = 0.0;
  limited_by_ = "nothing";
  for (const Member& m : members_)
    if (m.limits.largest_omega2 > largest) {
      largest = m.limits.largest_omega2;
      limited_by_ = fmt::format("{} of {}", m.limits.limited_by, m.name);
    }
  for (Joint& joint : joints_) {
    Coupling::PointLimits own[2];
    for (int s = 0; s < 2; ++s) {
      const Limits& limits = joint.side[s]->limits;
      own[s] = {limits.inverse_mass[joint.interface[s]], limits.omega2[joint.interface[s]]};
    }
    const auto [a, b] = joint.coupling->coupled_omega2(own[0], own[1]);
    for (const auto& [omega2, s] : {std::pair{a, 0}, std::pair{b, 1}})
      if (omega2 > largest) {
        largest = omega2;
        limited_by_ = fmt::format("the penalty of {} on {}", joint.name, joint.side[s]->name);
      }
  }
  critical_step_ = largest > 0.0 ? 2.0 / std::sqrt(largest) : INFINITY; // Rojek (2008) eq. 10

  const nlohmann::json& table = setup_.settings.at("case");
  double step = 0.0;
  if (table.at("time_step").is_number()) {
    step = table.at("time_step");
    if (step > critical_step_ && !table.at("allow_unstable").get<bool>())
      throw RunError(ErrorKind::bad_input, "case.time_step",
                     fmt::format("{:g} s is above the critical time step of {:.6g} s, which {} "
                                 "sets\ngive at most {:.3g}, or \"auto\"",
                                 step, critical_step_, limited_by_, 0.99 * critical_step_));
  } else if (std::isinf(critical_step_)) {
    throw RunError(ErrorKind::bad_input, "case.time_step",
                   "\"auto\" finds nothing that limits the step\ngive a number in seconds");
  } else {
    step = table.at("time_step_factor").get<double>() * critical_step_;
  }
  if (table.at("end_time").is_null()) {
    schedule_.time_step = step;
    last_step_ = UINT64_MAX;
  } else {
    const double end_time = table.at("end_time");
    last_step_ = steps_until(end_time, step, "case.end_time");
    schedule_.time_step =
        table.at("time_step").is_number() ? step : end_time / static_cast<double>(last_step_);
  }
  count_stages();
  const auto every = [&](const char* key) -> std::uint64_t {
    const std::uint64_t samples = table.at("output").at(key);
    return samples == 0 ? 0 : std::max<std::uint64_t>(1, (schedule_.steps + samples - 1) / samples);
  };
  schedule_.history_every = std::max<std::uint64_t>(1, every("history"));
  schedule_.frame_every = every("frames");
  schedule_.checkpoint_every = every("checkpoints");
  if (setup_.restart)
    go_on_with_schedule();
}

void Broker::open_channels() {
  for (Joint& joint : joints_)
    joint.coupling->start(schedule_.time_step);
  if (setup_.restart)
    restore_couplings();
  for (Member& m : members_) {
    Schedule schedule = schedule_;
    if (setup_.plan_only)
      schedule.steps = 0;
    if (!m.plan.interfaces.empty() && !setup_.plan_only) {
      m.layout = FrameLayout(m.declaration.dimension, m.declaration.ids, m.plan.interfaces);
      m.address.transport = setup_.transport;
      m.address.descriptor = m.segment;
      m.address.up_capacity = m.layout.up_capacity();
      m.address.down_capacity = m.layout.down_capacity();
      if (setup_.transport == "zmq")
        m.address.endpoint =
            fmt::format("ipc://@kerf-{}-{}-{}", getpid(), token_.substr(0, 16), m.name);
      else if (setup_.transport == "shm")
        m.address.endpoint = fmt::format("/proc/{}/fd/{}", getpid(), m.segment);
      else
        m.address.endpoint = fmt::format("{}-{}", token_, m.name);
      m.channel = open_broker_end(m.address);
      schedule.channel = m.address;
      schedule.layout = m.layout.checksum();
    }
    tell(m, to_message(schedule));
    m.heard = Clock::now();
  }
  phase_.clear();
}

void Broker::await_finish() {
  while (std::ranges::any_of(members_, [](const Member& m) { return !m.finished; })) {
    serve(std::chrono::milliseconds(50));
  }
}

void Broker::say_goodbye() {
  for (Member& m : members_) {
    supervisor_.release(m.name);
    Message goodbye;
    goodbye.type = message::goodbye;
    tell(m, goodbye);
  }
}

// ---- messages beside the steps ------------------------------------------------------------------

void Broker::serve(std::chrono::milliseconds limit) {
  last_service_ = Clock::now();
  supervisor_.check();
  while (true) {
    std::optional<ControlServer::Incoming> incoming;
    try {
      incoming = control_->receive(limit);
    } catch (const ProtocolError& error) {
      spdlog::warn("ignored a message that does not follow the protocol: {}", error.what());
      continue;
    }
    if (!incoming)
      break;
    limit = std::chrono::milliseconds(0);
    const auto known = std::ranges::find(members_, incoming->peer, &Member::peer);
    if (known != members_.end())
      handle(*known, incoming->message);
    else
      greet(incoming->peer, incoming->message);
  }
  check_silence();
  report_progress();
}

void Broker::handle(Member& m, const Message& message) {
  m.heard = Clock::now();
  try {
    if (message.type == message::progress) {
      m.step = from_message<Progress>(message).step;
    } else if (message.type == message::error) {
      const auto report = from_message<ErrorReport>(message);
      if (report.kind == ErrorKind::bad_input)
        throw RunError(report.kind, key_in_case(m.name, report.key), report.sentence);
      throw RunError(report.kind, "",
                     fmt::format("participant \"{}\" (pid {}) failed {}: {}", m.name, m.pid,
                                 place(), report.sentence));
    } else if (message.type == message::checkpoint) {
      m.checkpoint = from_message<CheckpointReport>(message).step;
      m.step = m.checkpoint;
      complete_checkpoint();
    } else if (message.type == message::condition) {
      end_early(m, from_message<ConditionMet>(message));
    } else if (message.type == message::finished) {
      if (!setup_.plan_only && (!phase_.empty() || (m.channel && step_ + 1 < schedule_.steps)))
        throw ProtocolError("it finished before the end of the run");
      m.timing = from_message<Finished>(message);
      m.step = m.timing.steps;
      m.finished = true;
    } else if (message.type == expected_ && !m.answered) {
      take_(m, message);
      m.answered = true;
    } else {
      throw ProtocolError(
          fmt::format("a message \"{}\" was not expected {}", message.type, place()));
    }
  } catch (const ProtocolError& error) {
    throw RunError(ErrorKind::failed, "",
                   fmt::format("participant \"{}\" (pid {}) broke the protocol: {}", m.name, m.pid,
                               error.what()));
  }
}

/// A participant without interfaces, or at the end of its run, shows by its progress that it lives;
/// the frames of the others have deadlines of their own.
void Broker::check_silence() {
  if (!phase_.empty())
    return;
  const double limit = setup_.settings.at("case").at("hang_limit");
  for (const Member& m : members_)
    if (!m.finished && (!m.channel || step_ == schedule_.steps) &&
        Clock::now() - m.heard > std::chrono::duration<double>(limit))
      throw RunError(ErrorKind::failed, "",
                     fmt::format("participant \"{}\" (pid {}) was silent for {:g} s at step {} of "
                                 "{}. Its log: {}",
                                 m.name, m.pid, limit, m.step, schedule_.steps,
                                 log_of(m).string()));
}

void Broker::tell(Member& m, const Message& message) {
  control_->send(m.peer, message);
}

void Broker::stop_all(const std::string& reason) noexcept {
  try {
    for (Member& m : members_)
      if (!m.peer.empty())
        tell(m, to_message(Stop{fmt::format("the run was stopped {}: {}", place(), reason)}));
  } catch (const std::exception& error) {
    spdlog::warn("could not tell every participant to stop: {}", error.what());
  }
}

RunError Broker::last_words(const ParticipantLost& loss) {
  // Perhaps it said what was wrong before it ended.
  try {
    while (const auto incoming = control_->receive(std::chrono::milliseconds(50)))
      if (incoming->peer == member(loss.name()).peer && incoming->message.type == message::error)
        handle(member(loss.name()), incoming->message);
  } catch (const RunError& error) {
    return error;
  } catch (const ProtocolError& error) {
    spdlog::warn("ignored a message that does not follow the protocol: {}", error.what());
  }
  const Member& gone = member(loss.name());
  std::vector<std::string> others;
  for (const Member& m : members_)
    if (&m != &gone && m.channel)
      others.push_back(m.name);
  return RunError(ErrorKind::failed, "",
                  fmt::format("participant \"{}\" (pid {}) {} {}{}. Its log: {}. {}", gone.name,
                              loss.pid(), loss.what(), place_of(gone),
                              gone.channel && !others.empty()
                                  ? fmt::format("; {} waited for the forces of that step",
                                                fmt::join(others, ", "))
                                  : "",
                              log_of(gone).string(), last_checkpoint()));
}

std::filesystem::path Broker::log_of(const Member& m) const {
  return setup_.run_folder / "logs" / (m.name + ".log");
}

Broker::Member& Broker::member(const std::string& name) {
  const auto found = std::ranges::find(members_, name, &Member::name);
  if (found == members_.end())
    throw std::invalid_argument("no participant \"" + name + "\"");
  return *found;
}

std::string Broker::place() const {
  const bool is_one = members_.size() == 1 && joints_.empty(); // which steps on its own
  return phase_.empty() ? fmt::format("at step {} of {}", is_one ? members_.front().step : step_,
                                      schedule_.steps)
                        : phase_;
}

std::string Broker::place_of(const Member& m) const {
  return phase_.empty() && !m.channel
             ? fmt::format("at about step {} of {}", m.step, schedule_.steps)
             : place();
}

void Broker::report_progress() {
  if (!setup_.progress || !phase_.empty() ||
      Clock::now() - last_report_ < std::chrono::milliseconds(200))
    return;
  last_report_ = Clock::now();
  for (const Member& m : members_)
    setup_.progress(m.name, m.channel ? step_ : m.step, schedule_.steps);
}

nlohmann::json Broker::record() const {
  nlohmann::json record;
  record["time_step"] = schedule_.time_step;
  record["critical_time_step"] = critical_step_;
  record["limited_by"] = limited_by_;
  record["steps"] = schedule_.steps;
  record["stage_ends"] = schedule_.ends;
  record["conditions"] = conditions_;
  record["transport"] = setup_.transport;
  for (const Member& m : members_) {
    nlohmann::json& entry = record["participants"][m.name];
    entry["kind"] = m.kind;
    entry["program"] = m.program;
    entry["points"] = m.declaration.num_points();
    if (m.declaration.nodes_per_element > 0)
      entry["elements"] =
          m.declaration.elements.size() / static_cast<std::size_t>(m.declaration.nodes_per_element);
    entry["memory_estimate"] = m.declaration.memory_estimate;
    if (!setup_.plan_only)
      entry["seconds"] = {{"compute", m.timing.compute_seconds},
                          {"waiting", m.timing.waiting_seconds},
                          {"exchange", m.timing.exchange_seconds}};
    entry["summary"] = nlohmann::json::parse(m.timing.summary, nullptr, false);
  }
  record["couplings"] = nlohmann::json::object();
  for (const Joint& joint : joints_)
    record["couplings"][joint.name] = {{"particles", joint.coupling->side(0).points.size()},
                                       {"nodes", joint.coupling->side(1).points.size()}};
  if (!setup_.plan_only)
    record["loop_seconds"] = loop_seconds_;
  return record;
}

} // namespace kerf::coupler
