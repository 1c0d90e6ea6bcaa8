// kerf-fem: joins the run that started it as a finite element participant.
#include "common/exit_code.hpp"
#include "common/log.hpp"
#include "fem_core/program/fem_participant.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string_view>

namespace {

constexpr const char* program = "kerf-fem " KERF_VERSION;

int run(kerf::coupler::Participant& participant) {
  using kerf::coupler::ErrorKind;
  try {
    return kerf::fem::run_fem(participant);
  } catch (const kerf::coupler::SettingsError& error) {
    spdlog::error("{}: {}", error.key(), error.what());
    participant.fail(ErrorKind::bad_input, error.key(), error.what());
    return kerf::exit_code::bad_input;
  } catch (const kerf::coupler::RunStopped& stop) {
    spdlog::error("{}", stop.what());
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    participant.fail(ErrorKind::failed, "", error.what());
  }
  return kerf::exit_code::run_failed;
}

} // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "--version") {
    fmt::print("{}\n", program);
    return kerf::exit_code::done;
  }
  if (std::getenv("KERF_BROKER") == nullptr) {
    fmt::print(stderr, "kerf-fem is started by `kerf run CASE.toml`, for the participants whose "
                       "solver it is.\n");
    return kerf::exit_code::bad_input;
  }
  try {
    auto participant = kerf::coupler::Participant::join(program);
    kerf::start_log({.name = participant.assignment().name, .file = {}, .to_stderr = true});
    return run(participant);
  } catch (const std::exception& error) {
    fmt::print(stderr, "kerf-fem: {}\n", error.what());
    return kerf::exit_code::run_failed;
  }
}
