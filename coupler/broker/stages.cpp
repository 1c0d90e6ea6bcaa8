// Stages of a run: when each one ends, and what a condition that is met does to the schedule.
#include "coupler/broker/members.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

namespace kerf::coupler {

/// Participants would have to agree on the step: so far there may be one.
void Broker::require_stages() const {
  const bool has_stages = !setup_.settings.at("stages").empty();
  if (!has_stages && setup_.settings.at("case").at("stop").empty())
    return;
  const std::string key = has_stages ? "stages" : "case.stop";
  const Member& m = members_.front();
  if (members_.size() > 1)
    throw RunError(ErrorKind::bad_input, key,
                   fmt::format("the case has {} participants; stages and stop conditions are for "
                               "one\nleave them out",
                               members_.size()));
  if (!m.declaration.has_stages)
    throw RunError(
        ErrorKind::bad_input, key,
        fmt::format("participant \"{}\" ({}) has no stages or stop conditions\nleave them "
                    "out, or use kerf-dem or kerf-fem",
                    m.name, m.program));
}

void Broker::count_stages() {
  const nlohmann::json& stages = setup_.settings.at("stages");
  std::uint64_t end = 0;
  for (const nlohmann::json& stage : stages) {
    const double steps = stage.at("duration").get<double>() / schedule_.time_step;
    end += static_cast<std::uint64_t>(std::max(1.0, std::ceil(steps * (1.0 - 1e-12))));
    schedule_.ends.push_back(end);
  }
  if (stages.empty())
    schedule_.ends = {last_step_};
  schedule_.steps = std::min(schedule_.ends.back(), last_step_);
}

/// Steps stay as long as they were, and results as far apart; only the end may be another.
void Broker::go_on_with_schedule() {
  const nlohmann::json& record = setup_.restart->record;
  const nlohmann::json& end_time = setup_.settings.at("case").at("end_time");
  schedule_.first_step = record.at("step");
  schedule_.time_step = record.at("time_step");
  schedule_.history_every = record.at("history_every");
  schedule_.frame_every = record.at("frame_every");
  conditions_ = record.at("conditions");
  if (end_time == record.at("settings").at("case").at("end_time"))
    last_step_ = record.at("last_step");
  else
    last_step_ = end_time.is_null()
                     ? UINT64_MAX
                     : static_cast<std::uint64_t>(
                           std::ceil(end_time.get<double>() / schedule_.time_step * (1.0 - 1e-12)));
  schedule_.ends = record.at("stage_ends").get<std::vector<std::uint64_t>>();
  if (setup_.settings.at("stages").empty() && conditions_.empty())
    schedule_.ends = {last_step_};
  schedule_.steps = std::min(schedule_.ends.back(), last_step_);
  if (schedule_.steps <= schedule_.first_step)
    throw RunError(ErrorKind::bad_input, "case.end_time",
                   fmt::format("the run ends at t = {:g} s, which is not after the checkpoint of "
                               "t = {:g} s\nend later, or go on from an earlier checkpoint",
                               static_cast<double>(schedule_.steps) * schedule_.time_step,
                               static_cast<double>(schedule_.first_step) * schedule_.time_step));
}

void Broker::end_early(Member& m, const ConditionMet& met) {
  if (members_.size() > 1 || met.step >= schedule_.steps)
    throw ProtocolError(fmt::format("its condition \"{}\" cannot end step {}", met.name, met.step));
  const std::uint64_t end = met.step + 1;
  std::vector<std::uint64_t>& ends = schedule_.ends;
  const auto stage =
      static_cast<std::size_t>(std::ranges::upper_bound(ends, met.step) - ends.begin());
  const nlohmann::json& of_run = setup_.settings.at("case").at("stop");
  const bool ends_run = std::ranges::any_of(
      of_run, [&](const nlohmann::json& stop) { return stop.at("name") == met.name; });
  if (ends_run) {
    ends.resize(stage + 1);
    ends.back() = end;
  } else {
    const std::uint64_t earlier = ends[stage] - end;
    for (std::size_t k = stage; k < ends.size(); ++k)
      ends[k] -= earlier;
  }
  schedule_.steps = std::min(ends.back(), last_step_);
  nlohmann::json entry = {{"name", met.name},
                          {"value", met.value},
                          {"step", met.step},
                          {"time", static_cast<double>(met.step) * schedule_.time_step},
                          {"ends", ends_run ? "run" : "stage"}};
  if (const nlohmann::json& stages = setup_.settings.at("stages"); !stages.empty())
    entry["stage"] = stages.at(stage).at("name");
  conditions_.push_back(entry);
  spdlog::info("condition {} is met at step {}", met.name, met.step);
  tell(m, to_message(Ends{schedule_.steps, ends}));
}

} // namespace kerf::coupler
