// A coupling between two participants, as the broker's step cycle sees it.
#pragma once

#include "common/state.hpp"
#include "coupler/channel/bodies.hpp"

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace kerf::coupler {

/// The case asks for a coupling that its bodies do not allow.
class CouplingError : public std::runtime_error {
public:
  /// @param key       path inside the table of the coupling, for example "boundary"
  /// @param sentence  what is wrong, then a line break and what to do instead
  CouplingError(std::string key, const std::string& sentence)
      : std::runtime_error(sentence), key_(std::move(key)) {}
  const std::string& key() const noexcept { return key_; }

private:
  std::string key_;
};

/// Row of a coupling's history; the books close to round-off in every step.
struct CouplingBook {
  double momentum_residual = 0.0;         // |sum f| / sum |f|, largest so far
  double angular_momentum_residual = 0.0; // |sum x × f| / sum |x| |f|, largest so far
  double constraint_violation = 0.0;      // largest |chi| so far, m
  double work[2] = {0.0, 0.0};            // done on each side since the start, J
  double stored_energy = 0.0;             // in the coupling at this instant, J
  bool finite = true;                     // every force so far was a number
};

template <class Visit> void visit_parts(CouplingBook& book, Visit& visit) {
  auto& [momentum_residual, angular_momentum_residual, constraint_violation, work, stored_energy,
         finite] = book;
  visit("momentum_residual", momentum_residual);
  visit("angular_momentum_residual", angular_momentum_residual);
  visit("constraint_violation", constraint_violation);
  visit("work_on_particles", work[0]);
  visit("work_on_mesh", work[1]);
  visit("stored_energy", stored_energy);
  visit("finite", finite);
}

class Coupling {
public:
  virtual ~Coupling() = default;

  /// What one side has to know and what it answers. Side 0 has the particles, side 1 the mesh.
  struct Side {
    std::vector<double> weights;       // [all points of the participant]; empty: one
    std::vector<std::uint32_t> points; // [n] interface points, ascending
    std::vector<double> stiffness;     // [n] N/m, may be empty
  };
  const Side& side(int s) const { return side_[s]; }

  /// True when compute() reads the own forces.
  virtual bool needs_own_forces() const = 0;

  struct PointLimits {
    std::span<const double> inverse_mass; // [n][dim] 1/kg; 0: prescribed
    std::span<const double> omega2;       // [n] of the uncoupled participant, rad²/s²
  };
  /// Largest eigenvalue bound of M^-1 K at the points of each side, with the coupling's stiffness,
  /// rad²/s²; keeps the inverse masses.
  virtual std::pair<double, double> coupled_omega2(const PointLimits& a, const PointLimits& b) = 0;

  virtual void start(double time_step) = 0;

  struct Motion {
    std::span<const double> position;   // [n][dim] x^n, m
    std::span<const double> velocity;   // [n][dim] v^(n-1/2), m/s; v^0 in the first step
    std::span<const double> own_forces; // [n][dim] N; empty unless needs_own_forces()
  };
  /// Forces of step n on the points of both sides, [n][dim] N.
  virtual void compute(std::uint64_t step, const Motion& a, const Motion& b,
                       std::span<double> force_a, std::span<double> force_b) = 0;
  /// Enters what compute() just gave; need not be ready before the participants go on.
  virtual void enter_books(std::uint64_t step, const Motion& a, const Motion& b,
                           std::span<const double> force_a, std::span<const double> force_b) = 0;

  /// What a restart needs beside the state of the participants, between two steps.
  virtual State state() const = 0;
  /// After start(). @throws std::invalid_argument when it is of another coupling
  virtual void restore(const State& state) = 0;

  const CouplingBook& book() const { return book_; }

protected:
  Side side_[2];
  CouplingBook book_;
};

/// Settings of an overlap, as in the table [[couplings]] of a case.
struct OverlapSettings {
  std::string name;
  std::string boundary;           // tag of the mesh boundary where alpha = 0
  double width = 0.0;             // of the zone, m
  bool lagrange = true;           // or penalty
  double stiffness_ratio = 1.0;   // kappa = k_DF / k_n
  bool uniform_stiffness = false; // or 4 alpha (1 - alpha)
  bool blending = true;           // or both bodies with their full masses and forces
  std::vector<double> period{};   // [dim] length of each axis, m; 0: not periodic
};

/// Finds the particles inside the mesh and prepares the constraint between them.
/// @throws CouplingError when the bodies do not overlap, the boundary does not exist, or a
///         particle lies in the mesh beyond the width
std::unique_ptr<Coupling> make_overlap(const OverlapSettings& settings,
                                       const Declaration& particles, const Declaration& mesh);

} // namespace kerf::coupler
