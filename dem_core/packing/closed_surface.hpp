// A region inside a closed surface: a polygon in 2D, a triangle mesh in 3D.
#pragma once

#include "common/surface.hpp"
#include "dem_core/packing/region.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace kerf::dem {

/// The sign of the distance is that of the angle-weighted normal at the nearest point, which is
/// right at corners and edges, too: Baerentzen & Aanaes, IEEE Trans. Vis. Comput. Graph. 11 (2005)
/// 243-253, doi:10.1109/TVCG.2005.49.
template <int dim> class ClosedSurface final : public Region<dim> {
public:
  /// @param vertices  m
  /// @param facets    all turned the same way, outwards or inwards
  /// @throws std::invalid_argument when the surface has a hole, a facet without extent or turned
  ///         against its neighbour, or an edge of more than two facets
  ClosedSurface(std::vector<Vec<dim>> vertices, std::vector<Facet<dim>> facets);

  double volume() const override { return volume_; }
  Box<dim> bounds() const override { return {tree_.front().lower, tree_.front().upper}; }
  Wall<dim> wall(const Vec<dim>& point) const override;

private:
  /// The facets from first to last, or two parts of them; the first part is the next node.
  struct Node {
    Vec<dim> lower, upper;
    std::uint32_t first, last; // facets
    std::uint32_t second_part; // node; zero when the node is not divided
  };
  struct Nearest;

  void check_closed() const;
  void turn_outwards();
  void build_tree(std::uint32_t first, std::uint32_t last);
  void make_normals();
  Vec<dim> normal(const Facet<dim>& facet) const; // outward, length: extent times (dim - 1)
  void search_facet(const Vec<dim>& point, std::uint32_t facet, Nearest& nearest) const;

  std::vector<Vec<dim>> vertices_;
  std::vector<Facet<dim>> facets_;
  double volume_ = 0.0;
  std::vector<Node> tree_;

  // Outward normals of any length, at whatever may be nearest to a point.
  std::vector<Vec<dim>> facet_normals_, vertex_normals_;
  std::vector<std::array<Vec<dim>, 3>> edge_normals_; // 3D: of the edge after each corner
};

} // namespace kerf::dem
