#include "fem_core/program/gmsh_session.hpp"

#include "fem_core/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmsh.h>
#include <omp.h>

#include <vector>

namespace kerf::fem {

GmshSession::GmshSession() : num_threads_(omp_get_max_threads()) {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  // An exception out of its parser would leave Gmsh locked for good; the log tells as much.
  gmsh::option::setNumber("General.AbortOnError", 0);
  gmsh::logger::start();
}

GmshSession::~GmshSession() {
  gmsh::logger::stop();
  gmsh::finalize();
  omp_set_num_threads(num_threads_);
}

void GmshSession::check(const std::filesystem::path& path) {
  std::vector<std::string> log, errors;
  gmsh::logger::get(log);
  for (; num_read_ < log.size(); ++num_read_)
    if (log[num_read_].starts_with("Error: "))
      errors.push_back(log[num_read_].substr(7));
  if (!errors.empty())
    throw InputError("mesh.file",
                     fmt::format("Gmsh cannot use {}: {}", path.string(), fmt::join(errors, "; ")));
}

} // namespace kerf::fem
