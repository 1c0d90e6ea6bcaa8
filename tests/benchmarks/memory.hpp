// How much memory this process has.
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <fstream>

namespace kerf::benchmarks {

/// Resident memory without what has been set free, byte.
inline double resident_memory() {
  malloc_trim(0);
  double all = 0.0, resident = 0.0; // pages
  std::ifstream("/proc/self/statm") >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

} // namespace kerf::benchmarks
