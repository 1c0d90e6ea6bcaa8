// Checkpoints of a run: every participant writes its own state, the broker that of the couplings
// and, when all of it is there, the record that makes it a checkpoint.
#include "common/atomic_file.hpp"
#include "common/checkpoint.hpp"
#include "coupler/broker/members.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace kerf::coupler {

namespace fs = std::filesystem;

void Broker::require_checkpoints() const {
  const nlohmann::json& output = setup_.settings.at("case").at("output");
  const bool writes = output.at("checkpoints") != 0;
  if (!writes && !setup_.restart)
    return;
  for (const Member& m : members_)
    if (!m.declaration.has_checkpoints)
      throw RunError(ErrorKind::bad_input, "case.output.checkpoints",
                     fmt::format("participant \"{}\" ({}) cannot {}\n{}", m.name, m.program,
                                 writes ? "write checkpoints" : "go on from a checkpoint",
                                 writes ? "give 0" : "run the case without --restart"));
}

fs::path Broker::coupling_file(const fs::path& folder, const Joint& joint) const {
  return folder / "couplings" / (joint.name + ".h5");
}

void Broker::restore_couplings() {
  checkpoint_ = schedule_.first_step;
  // Before anybody takes a step, and writes the next one.
  remove_checkpoints_after(setup_.run_folder, schedule_.first_step);
  for (Joint& joint : joints_) {
    const fs::path file = coupling_file(setup_.restart->folder, joint);
    try {
      joint.coupling->restore(read_checkpoint(file, "kerf " + setup_.version).state);
    } catch (const CheckpointError& error) {
      throw RunError(ErrorKind::bad_input, "couplings",
                     fmt::format("{}\nuse another one", error.what()));
    } catch (const std::invalid_argument& error) {
      throw RunError(ErrorKind::bad_input, "couplings",
                     fmt::format("{} does not fit the case: {}\nuse another one", file.string(),
                                 error.what()));
    }
  }
}

bool Broker::checkpoint_is_due() const {
  return schedule_.checkpoint_every != 0 && step_ > schedule_.first_step &&
         (step_ % schedule_.checkpoint_every == 0 || step_ == schedule_.steps);
}

void Broker::write_couplings() {
  const fs::path folder = checkpoint_folder(setup_.run_folder, step_);
  for (const Joint& joint : joints_)
    write_checkpoint(coupling_file(folder, joint),
                     {"kerf " + setup_.version, step_, joint.coupling->state()});
  couplings_written_ = step_;
  complete_checkpoint();
}

/// The slowest decides: who has written a later one has written this one, too.
void Broker::complete_checkpoint() {
  std::uint64_t step = joints_.empty() ? UINT64_MAX : couplings_written_;
  for (const Member& m : members_)
    step = std::min(step, m.checkpoint);
  if (step <= checkpoint_ && !(step == schedule_.first_step && step == checkpoint_))
    return;
  if (step == 0)
    return;
  nlohmann::json record = setup_.identity;
  record["step"] = step;
  record["time"] = static_cast<double>(step) * schedule_.time_step;
  record["time_step"] = schedule_.time_step;
  record["steps"] = schedule_.steps;
  record["history_every"] = schedule_.history_every;
  record["frame_every"] = schedule_.frame_every;
  record["last_step"] = last_step_;
  record["stage_ends"] = schedule_.ends;
  record["conditions"] = conditions_;
  write_text(checkpoint_folder(setup_.run_folder, step) / "checkpoint.json", record.dump(2) + "\n");
  checkpoint_ = step;
  const nlohmann::json& output = setup_.settings.at("case").at("output");
  keep_checkpoints(setup_.run_folder, output.at("keep_checkpoints"));
  spdlog::info("checkpoint at step {}", step);
}

/// Alone, a participant can write one wherever it is. Several would first have to agree on a step:
/// their last common one stays the last.
void Broker::await_last_checkpoint() noexcept {
  try {
    if (!phase_.empty() || members_.size() != 1 || !members_.front().declaration.has_checkpoints)
      return;
    Member& m = members_.front();
    const std::uint64_t before = m.checkpoint;
    tell(m, {message::checkpoint, "{}", {}});
    while (m.checkpoint == before && !m.finished)
      serve(std::chrono::milliseconds(50)); // which a second signal, a death or silence ends
  } catch (const std::exception& error) {
    spdlog::warn("no checkpoint was written at the end: {}", error.what());
  }
}

std::string Broker::last_checkpoint() const {
  if (checkpoint_ == 0)
    return "No checkpoint was written";
  return fmt::format("Go on from step {} with --restart {}", checkpoint_,
                     setup_.run_folder.string());
}

} // namespace kerf::coupler
