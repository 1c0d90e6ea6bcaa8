// Forces on nodes: given ones, tractions, and pressure on faces that deform.
#pragma once

#include "fem_core/face.hpp"
#include "fem_core/kernels/patch_view.hpp"
#include "fem_core/settings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace kerf::fem {

/// Integrals of the shape functions over a face, int N_a dA: m² (m in 2D); of the whole ring in
/// axisymmetry.
template <int dim> std::vector<double> face_weights(const FaceCorners<dim>& corners, Space space);

template <int dim> class Loads {
public:
  Loads() = default;
  /// @throws InputError for an unknown tag, a tag without what the kind of load needs, or a box
  ///         without a node
  Loads(const Mesh<dim>& mesh, std::vector<LoadSetting<dim>> settings, Space space);

  /// Those that carry a load, ascending.
  std::span<const std::uint32_t> nodes() const { return nodes_; }
  /// Forces at a time, N.
  /// @param displacement  [nodes][dim] of nodes(), m
  /// @param force         [nodes][dim] receives them
  void compute(double time, std::span<const double> displacement, std::span<double> force) const;
  /// Sum of the forces of one of them, N; arguments as of compute().
  Vec<dim> resultant(std::size_t load, double time, std::span<const double> displacement) const;
  /// How many nodes one of them acts on.
  std::size_t num_nodes(std::size_t load) const { return num_nodes_[load]; }

private:
  struct Share { // of a node in a load: the force is weight times the value
    std::uint32_t place;
    double weight;
  };
  struct Pushed { // a face
    std::uint32_t size;
    std::uint32_t place[4];
    FaceCorners<dim> corners; // of the reference configuration
  };

  void add(std::size_t load, double time, std::span<const double> displacement,
           std::span<double> force) const;

  std::vector<LoadSetting<dim>> settings_;
  std::vector<std::size_t> num_nodes_; // [settings]
  Space space_ = Space::plane;
  std::vector<std::uint32_t> nodes_;
  std::vector<std::vector<Share>> shares_;  // [settings]
  std::vector<std::vector<Pushed>> pushed_; // [settings]
};

} // namespace kerf::fem
