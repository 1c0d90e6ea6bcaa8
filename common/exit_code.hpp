// What a kerf program tells the shell that started it.
#pragma once

namespace kerf::exit_code {

enum ExitCode : int {
  done = 0,
  check_failed = 1,  // a comparison or the expectation of a measure
  bad_input = 2,     // the case file or the command line
  run_failed = 3,    // a participant failed, or a bound was exceeded while running
  interrupted = 130, // Ctrl-C
  terminated = 143   // SIGTERM
};

} // namespace kerf::exit_code
