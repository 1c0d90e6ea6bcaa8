#include "coupler/broker/process_supervisor.hpp"

#include <csignal>
#include <thread>

namespace kerf::coupler {
namespace {

volatile std::sig_atomic_t received_signal = 0;
constexpr int ending_signals[] = {SIGINT, SIGTERM, SIGHUP};

void remember(int signal) {
  received_signal = signal;
}

} // namespace

ProcessSupervisor::ProcessSupervisor(nlohmann::json participants, std::filesystem::path programs,
                                     std::filesystem::path logs)
    : participants_(std::move(participants)), programs_(std::move(programs)),
      logs_(std::move(logs)) {
  received_signal = 0;
  for (const int signal : ending_signals)
    std::signal(signal, remember);
}

ProcessSupervisor::~ProcessSupervisor() {
  for (const int signal : ending_signals)
    std::signal(signal, SIG_DFL);
}

void ProcessSupervisor::start(const Participant::Invitation& invitation) {
  const nlohmann::json& table = participants_.at(invitation.name);
  Command command;
  command.name = invitation.name;
  if (!table.at("command").is_null())
    command.arguments = table.at("command").get<std::vector<std::string>>();
  else
    command.arguments = {(programs_ / table.at("solver").get<std::string>()).string()};
  command.log = logs_ / (invitation.name + ".log");
  command.segment = invitation.segment;
  command.environment = {{"KERF_BROKER", invitation.endpoint},
                         {"KERF_PARTICIPANT", invitation.name},
                         {"KERF_TOKEN", invitation.token},
                         // Threads that spin between parallel regions would take the cores that
                         // the other participants and the broker need.
                         {"OMP_WAIT_POLICY", "passive"},
                         {"OMP_PROC_BIND", "false"}};
  if (table.at("threads").is_number())
    command.environment["OMP_NUM_THREADS"] = std::to_string(table.at("threads").get<int>());
  else
    command.environment["OMP_NUM_THREADS"] = std::to_string(
        std::max(1u, std::thread::hardware_concurrency() /
                         static_cast<unsigned>(std::max<std::size_t>(1, participants_.size()))));
  launcher_.start(command);
}

void ProcessSupervisor::check() {
  if (received_signal != 0) {
    const int signal = received_signal;
    received_signal = 0; // a second one is told again
    throw Interrupted(signal);
  }
  for (const Ending& ending : launcher_.ended())
    if (!released_.contains(ending.name))
      throw ParticipantLost(ending.name, ending.pid, ending.sentence());
}

} // namespace kerf::coupler
