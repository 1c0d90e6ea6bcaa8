// Which facets of a surface are near a sphere.
#pragma once

#include "common/surface.hpp"
#include "common/vec.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kerf {

/// Facets sorted into the cells of a regular grid. The grid knows the vertices as they were when it
/// was made: of a rigid surface that moves, search in the frame of the body.
///
/// A list made with a reach of radius + skin holds all facets that can be touched until the centre
/// has moved by the skin in that frame.
template <int dim> class FacetGrid {
public:
  /// @pre find_fault() finds none
  explicit FacetGrid(const Surface<dim>& surface);

  /// Lists all facets whose bounding box is within the reach, and no others, ascending.
  /// @param reach  from the centre, m
  /// @param found  receives the facets; what it held is dropped, its memory is used again
  void near(const Vec<dim>& centre, double reach, std::vector<std::uint32_t>& found) const;

private:
  using Index = std::array<std::int64_t, dim>;

  Index cell_of(const Vec<dim>& x) const; // the nearest cell of the grid
  std::size_t number(const Index& cell) const;
  /// Calls visit(cell) for all cells from lower to upper.
  template <class Visit> void for_each_cell(Index lower, Index upper, Visit visit) const;

  std::vector<Box<dim>> boxes_; // of the facets
  Box<dim> bounds_;
  double width_ = 0.0; // of a cell, m
  Index count_{};      // of cells along each axis
  // Facets of a cell: entries offset_[c] to offset_[c + 1] of facet_, ascending.
  std::vector<std::uint32_t> offset_, facet_;
};

} // namespace kerf
