// kerf - couples discrete element and finite element programs in one run.
#include "common/config/case_reader.hpp"
#include "common/exit_code.hpp"
#include "coupler/commands/commands.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  using kerf::commands::RunOptions;
  CLI::App app{"kerf couples discrete elements, where rock breaks, with finite elements, where it "
               "only deforms."};
  app.set_version_flag("--version", "kerf " KERF_VERSION);
  app.require_subcommand(1);
  app.footer("More: ./kerf test runs every test, ./kerf bench the benchmarks.");

  RunOptions options;
  int exit_code = kerf::exit_code::done;
  const auto add_case = [&](CLI::App* verb) {
    verb->add_option("case", options.case_file, "Case file (TOML)")->required();
    verb->add_option("--set", options.overrides, "Replaces a value of the case: key=value")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    verb->add_option("--transport", options.transport, "Replaces case.transport")
        ->check(CLI::IsMember({"shm", "zmq"}));
  };
  CLI::App* run = app.add_subcommand("run", "Runs a case and writes its results");
  add_case(run);
  run->add_option("--out", options.out, "Folder of the results [results/<case name>, or DIR]");
  run->add_option("--restart", options.restart,
                  "Goes on from the last checkpoint of a run, or from that of a step")
      ->type_name("DIR[@STEP]");
  run->callback([&] { exit_code = kerf::commands::run(options); });
  CLI::App* check = app.add_subcommand("check", "Checks a case and prints its plan, runs nothing");
  add_case(check);
  check->callback([&] { exit_code = kerf::commands::check(options); });

  CLI::App* pack = app.add_subcommand(
      "pack", "Makes, cuts, converts and measures packings; pack --help says more");
  pack->prefix_command();
  pack->set_help_flag();
  pack->callback([&] { exit_code = kerf::commands::pack(pack->remaining()); });

  CLI::App* reference = app.add_subcommand(
      "reference", "Prints every key of a case with its unit, default and range");
  reference->callback([] { std::fputs(kerf::config::reference_toml().c_str(), stdout); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kerf::exit_code::done : kerf::exit_code::bad_input;
  }
  return exit_code;
}
