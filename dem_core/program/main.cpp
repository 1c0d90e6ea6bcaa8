// kerf-dem: particles as one participant of a run.
#include "common/exit_code.hpp"
#include "common/log.hpp"
#include "coupler/participant/participant.hpp"
#include "dem_core/program/dem_participant.hpp"
#include "dem_core/program/pack.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

namespace {

using namespace kerf;

constexpr const char* program = "kerf-dem " KERF_VERSION;

int run(coupler::Participant& broker) {
  using coupler::ErrorKind;
  try {
    return dem::run_dem(broker);
  } catch (const coupler::SettingsError& error) {
    spdlog::error("{}: {}", error.key(), error.what());
    broker.fail(ErrorKind::bad_input, error.key(), error.what());
    return exit_code::bad_input;
  } catch (const coupler::RunStopped& stopped) {
    spdlog::error("{}", stopped.what());
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    broker.fail(ErrorKind::failed, "", error.what());
  }
  return exit_code::run_failed;
}

} // namespace

int main(int count, char** arguments) {
  if (count > 1 && std::string_view(arguments[1]) == "--version") {
    fmt::print("{}\n", program);
    return exit_code::done;
  }
  if (count > 1 && std::string_view(arguments[1]) == "pack")
    return dem::run_pack(count, arguments);
  if (std::getenv("KERF_BROKER") == nullptr) {
    fmt::print(stderr, "kerf-dem takes part in a run and is started by `kerf run CASE.toml`.\n");
    return exit_code::bad_input;
  }
  try {
    auto broker = coupler::Participant::join(program);
    start_log({.name = broker.assignment().name, .file = {}, .to_stderr = true});
    return run(broker);
  } catch (const std::exception& error) { // the broker cannot be reached or refuses
    fmt::print(stderr, "kerf-dem: {}\n", error.what());
    return exit_code::run_failed;
  }
}
