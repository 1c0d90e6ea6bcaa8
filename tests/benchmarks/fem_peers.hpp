// Other codes on the same mesh: FEniCSx and deal.II.
#pragma once

#include "tests/benchmarks/commands.hpp"
#include "tests/benchmarks/fem_models.hpp"

#include <string>
#include <vector>

namespace kerf::benchmarks {

struct FemPeer {
  std::string name; // fenicsx, petsc (a stiffness matrix of FEniCSx) or dealii
  std::string law;  // linear or neo_hookean

  /// Whether it computes the same as kerf with a law.
  bool computes(const std::string& of_kerf) const {
    return of_kerf == law || (of_kerf == "total_strain" && law == "linear");
  }
};

/// Those that can run a workload, with their programs; builds that for deal.II.
/// @throws std::runtime_error when a code is not installed
std::vector<FemPeer> fem_peers(const FemWorkload& workload);

/// A mesh of a workload with its start as files for the other codes.
template <int dim> class FemPeerModel {
public:
  FemPeerModel(const FemWorkload& workload, const fem::Mesh<dim>& mesh);

  /// Set-up and warm-up are not timed. Threads are MPI ranks.
  /// @throws std::runtime_error with the end of what the code said when it fails
  double seconds_per_step(const FemPeer& peer, int threads, int steps, int warm_up);

  /// u after the last run, [num_nodes][dim] m.
  std::vector<double> displacement() const;

private:
  std::size_t size_ = 0; // of the displacements
  TemporaryFolder folder_;
};

/// Runs kerf and a peer on a small mesh of a workload.
/// @return the largest difference of the displacements over the largest displacement
template <int dim>
double difference_from(const FemPeer& peer, const FemWorkload& workload, int threads);

} // namespace kerf::benchmarks
