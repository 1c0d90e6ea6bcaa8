// Boundaries that let waves out, and in.
#pragma once

#include "fem_core/face.hpp"
#include "fem_core/kernels/patch_view.hpp"
#include "fem_core/laws/moduli.hpp"
#include "fem_core/settings.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace kerf::fem {

/// What a wave finds behind a face.
struct Medium {
  Moduli moduli;        // Pa
  double density = 0.0; // kg/m³
};

/// Dashpots on faces: the traction -rho c_P v_n n - rho c_S v_t absorbs plane waves that meet the
/// boundary at right angles, and most of others. An incoming wave adds the traction that it has in
/// an endless body, and the one that its own motion finds at the dashpots.
/// @see J. Lysmer and R. L. Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859-877
template <int dim> class Absorbing {
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct Node {
    std::uint32_t node;
    Matrix damper = Matrix::Zero(); // C of the force -C v, N s/m
  };

  Absorbing() = default;
  /// @param medium  of an element
  /// @throws InputError for a tag without faces, or a wave whose polarization is neither along nor
  ///         across its direction
  Absorbing(const Mesh<dim>& mesh, std::vector<AbsorbingSetting<dim>> settings, Space space,
            const std::function<Medium(std::uint32_t element)>& medium);

  std::span<const Node> nodes() const { return nodes_; } // ascending
  bool has_waves() const { return !arrivals_.empty(); }
  /// Forces of the incoming waves, [nodes][dim], N.
  void incoming(double time, std::span<double> force) const;

private:
  struct Arrival { // a wave at a node
    std::uint32_t place;
    std::size_t setting;
    double delay;   // s
    Vec<dim> force; // of a velocity of one, N s/m
  };

  std::vector<AbsorbingSetting<dim>> settings_;
  std::vector<Node> nodes_;
  std::vector<Arrival> arrivals_;
};

} // namespace kerf::fem
