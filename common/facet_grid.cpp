#include "common/facet_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kerf {

namespace {

template <int dim> Box<dim> box_of(const FacetShape<dim>& x) {
  Box<dim> box{x[0], x[0]};
  for (const Vec<dim>& vertex : x) {
    box.lower = box.lower.cwiseMin(vertex);
    box.upper = box.upper.cwiseMax(vertex);
  }
  return box;
}

template <int dim> double squared_distance(const Vec<dim>& x, const Box<dim>& box) {
  return (x - x.cwiseMax(box.lower).cwiseMin(box.upper)).squaredNorm();
}

} // namespace

template <int dim>
FacetGrid<dim>::FacetGrid(const Surface<dim>& surface) : bounds_(bounding_box(surface)) {
  double mean_extent = 0.0;
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    boxes_.push_back(box_of<dim>(surface.shape(f)));
    mean_extent += (boxes_[f].upper - boxes_[f].lower).maxCoeff();
  }
  const auto num_facets = static_cast<double>(boxes_.size());
  mean_extent /= num_facets;

  // Cells as wide as a facet, but not many more of them than facets.
  const Vec<dim> size = bounds_.upper - bounds_.lower;
  width_ = mean_extent;
  const auto cells_along = [&](int a) { return 1.0 + std::floor(size[a] / width_); };
  const auto all_cells = [&] {
    double product = 1.0;
    for (int a = 0; a < dim; ++a)
      product *= cells_along(a);
    return product;
  };
  while (all_cells() > 8.0 * num_facets + 8.0)
    width_ *= 1.25;
  for (int a = 0; a < dim; ++a)
    count_[a] = static_cast<std::int64_t>(cells_along(a));

  const auto for_each_entry = [&](auto visit) {
    for (std::uint32_t f = 0; f < boxes_.size(); ++f)
      for_each_cell(cell_of(boxes_[f].lower), cell_of(boxes_[f].upper),
                    [&](const Index& cell) { visit(number(cell), f); });
  };
  offset_.assign(static_cast<std::size_t>(all_cells()) + 1, 0);
  for_each_entry([&](std::size_t cell, std::uint32_t) { ++offset_[cell + 1]; });
  std::partial_sum(offset_.begin(), offset_.end(), offset_.begin());
  facet_.resize(offset_.back());
  std::vector<std::uint32_t> next(offset_.begin(), offset_.end() - 1);
  for_each_entry([&](std::size_t cell, std::uint32_t f) { facet_[next[cell]++] = f; });
}

template <int dim>
void FacetGrid<dim>::near(const Vec<dim>& centre, double reach,
                          std::vector<std::uint32_t>& found) const {
  found.clear();
  const double limit = reach * reach;
  if (!(squared_distance<dim>(centre, bounds_) <= limit))
    return;
  const Vec<dim> extent = Vec<dim>::Constant(reach);
  const Index lower = cell_of(centre - extent), upper = cell_of(centre + extent);
  for_each_cell(lower, upper, [&](const Index& cell) {
    const std::size_t c = number(cell);
    for (std::uint32_t k = offset_[c]; k < offset_[c + 1]; ++k) {
      const std::uint32_t f = facet_[k];
      // A facet lies in many cells: it is listed in the first that the search shares with it.
      const Index begin = cell_of(boxes_[f].lower);
      bool is_first = true;
      for (int a = 0; a < dim; ++a)
        is_first = is_first && cell[a] == std::max(begin[a], lower[a]);
      if (is_first && squared_distance<dim>(centre, boxes_[f]) <= limit)
        found.push_back(f);
    }
  });
  std::sort(found.begin(), found.end());
}

template <int dim> typename FacetGrid<dim>::Index FacetGrid<dim>::cell_of(const Vec<dim>& x) const {
  Index cell;
  for (int a = 0; a < dim; ++a) {
    const double position = std::floor((x[a] - bounds_.lower[a]) / width_);
    cell[a] =
        static_cast<std::int64_t>(std::clamp(position, 0.0, static_cast<double>(count_[a] - 1)));
  }
  return cell;
}

template <int dim> std::size_t FacetGrid<dim>::number(const Index& cell) const {
  std::int64_t number = 0;
  for (int a = dim - 1; a >= 0; --a)
    number = number * count_[a] + cell[a];
  return static_cast<std::size_t>(number);
}

template <int dim>
template <class Visit>
void FacetGrid<dim>::for_each_cell(Index lower, Index upper, Visit visit) const {
  Index cell = lower;
  for (;;) {
    visit(cell);
    int a = 0;
    while (a < dim && ++cell[a] > upper[a]) {
      cell[a] = lower[a];
      ++a;
    }
    if (a == dim)
      return;
  }
}

template class FacetGrid<2>;
template class FacetGrid<3>;

} // namespace kerf
