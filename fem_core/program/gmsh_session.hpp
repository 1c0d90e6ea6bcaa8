// The Gmsh library, from its start to its end.
#pragma once

#include <filesystem>
#include <string>

namespace kerf::fem {

/// Gmsh keeps its state in globals: there is one session at a time. It prints nothing; it reads no
/// settings of the user, so that a mesh depends on its file only; and it leaves the number of
/// OpenMP threads alone, which Gmsh sets to one.
class GmshSession {
public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// @throws InputError("mesh.file") with what Gmsh said, when something failed since the last call
  void check(const std::filesystem::path& path);

private:
  int num_threads_;
  std::size_t num_read_ = 0; // lines of the log
};

} // namespace kerf::fem
