#include "coupler/methods/locate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kerf::coupler {
namespace {

/// Corners of the reference element [-1, 1]^dim in VTK's order.
template <int dim> constexpr std::array<std::array<double, dim>, corners<dim>> corner_signs() {
  if constexpr (dim == 2)
    return {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  else
    return {{{-1, -1, -1},
             {1, -1, -1},
             {1, 1, -1},
             {-1, 1, -1},
             {-1, -1, 1},
             {1, -1, 1},
             {1, 1, 1},
             {-1, 1, 1}}};
}

template <int dim> using Corners = std::array<Vec<dim>, corners<dim>>;

/// Corner positions of an element, all in the image of its first corner.
template <int dim> Corners<dim> corner_positions(const MeshView<dim>& mesh, std::size_t element) {
  Corners<dim> x;
  const auto node = [&](int a) {
    return Eigen::Map<const Vec<dim>>(mesh.nodes.data() +
                                      dim * mesh.elements[element * corners<dim> + a]);
  };
  x[0] = node(0);
  for (int a = 1; a < corners<dim>; ++a)
    x[a] = x[0] + mesh.period.shortest(node(a) - x[0]);
  return x;
}

template <int dim> std::array<double, corners<dim>> shape_at(const Vec<dim>& xi) {
  constexpr auto sign = corner_signs<dim>();
  std::array<double, corners<dim>> shape;
  for (int a = 0; a < corners<dim>; ++a) {
    shape[a] = 1.0;
    for (int k = 0; k < dim; ++k)
      shape[a] *= 0.5 * (1.0 + sign[a][k] * xi[k]);
  }
  return shape;
}

template <int dim> Eigen::Matrix<double, dim, dim> jacobian(const Corners<dim>& x, Vec<dim> xi) {
  constexpr auto sign = corner_signs<dim>();
  Eigen::Matrix<double, dim, dim> J = Eigen::Matrix<double, dim, dim>::Zero();
  for (int a = 0; a < corners<dim>; ++a)
    for (int k = 0; k < dim; ++k) {
      double derivative = 0.5 * sign[a][k];
      for (int l = 0; l < dim; ++l)
        if (l != k)
          derivative *= 0.5 * (1.0 + sign[a][l] * xi[l]);
      J.col(k) += derivative * x[a];
    }
  return J;
}

/// Newton's method for the reference coordinates of a point; exact at once for parallelograms.
template <int dim>
std::optional<std::array<double, corners<dim>>> inside(const Corners<dim>& x,
                                                       const Vec<dim>& point) {
  constexpr double slack = 1e-9; // of the element's half width: points on a face belong to it
  Vec<dim> xi = Vec<dim>::Zero();
  for (int iteration = 0; iteration < 20; ++iteration) {
    const auto shape = shape_at<dim>(xi);
    Vec<dim> residual = point;
    for (int a = 0; a < corners<dim>; ++a)
      residual -= shape[a] * x[a];
    const Vec<dim> change = jacobian<dim>(x, xi).partialPivLu().solve(residual);
    xi += change;
    if (!(xi.cwiseAbs().maxCoeff() < 10.0)) // far outside, or the map is singular there
      return std::nullopt;
    if (change.cwiseAbs().maxCoeff() < 1e-14)
      break;
  }
  if (xi.cwiseAbs().maxCoeff() > 1.0 + slack)
    return std::nullopt;
  return shape_at<dim>(xi);
}

/// Lists of the elements whose boxes touch each cell of a regular grid.
template <int dim> class ElementGrid {
public:
  explicit ElementGrid(const MeshView<dim>& mesh) : period_(mesh.period) {
    const std::size_t num_nodes = mesh.nodes.size() / dim;
    const std::size_t num_elements = mesh.elements.size() / corners<dim>;
    low_.setConstant(std::numeric_limits<double>::max());
    Vec<dim> high = -low_;
    for (std::size_t n = 0; n < num_nodes; ++n) {
      const Eigen::Map<const Vec<dim>> x(mesh.nodes.data() + dim * n);
      low_ = low_.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const double per_axis = std::max(1.0, std::floor(std::pow(num_elements, 1.0 / dim)));
    std::size_t cells = 1;
    for (int k = 0; k < dim; ++k) {
      const double length = period_.length[k] > 0.0 ? period_.length[k] : high[k] - low_[k];
      count_[k] = static_cast<std::int64_t>(per_axis);
      size_[k] = std::max(length, std::numeric_limits<double>::min()) / per_axis;
      cells *= static_cast<std::size_t>(count_[k]);
    }
    lists_.resize(cells);
    for (std::size_t e = 0; e < num_elements; ++e) {
      const Corners<dim> x = corner_positions(mesh, e);
      Vec<dim> least = x[0], most = x[0];
      for (const Vec<dim>& corner : x) {
        least = least.cwiseMin(corner);
        most = most.cwiseMax(corner);
      }
      add(static_cast<std::uint32_t>(e), least, most);
    }
  }

  /// Elements that may contain the point, ascending.
  std::span<const std::uint32_t> around(const Vec<dim>& point) const {
    std::size_t cell = 0;
    for (int k = dim - 1; k >= 0; --k) {
      std::int64_t i = cell_of(point[k], k);
      if (period_.length[k] > 0.0)
        i = ((i % count_[k]) + count_[k]) % count_[k];
      else if (i < -1 || i > count_[k])
        return {};
      i = std::clamp<std::int64_t>(i, 0, count_[k] - 1);
      cell = cell * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(i);
    }
    return lists_[cell];
  }

private:
  std::int64_t cell_of(double x, int k) const {
    return static_cast<std::int64_t>(std::floor((x - low_[k]) / size_[k]));
  }

  void add(std::uint32_t element, const Vec<dim>& least, const Vec<dim>& most) {
    std::array<std::int64_t, dim> from{}, to{}, i{};
    for (int k = 0; k < dim; ++k) {
      const double margin = 1e-6 * size_[k];
      from[k] = i[k] = cell_of(least[k] - margin, k);
      to[k] = cell_of(most[k] + margin, k);
    }
    while (true) {
      std::size_t cell = 0;
      for (int k = dim - 1; k >= 0; --k) {
        const std::int64_t wrapped = period_.length[k] > 0.0
                                         ? ((i[k] % count_[k]) + count_[k]) % count_[k]
                                         : std::clamp<std::int64_t>(i[k], 0, count_[k] - 1);
        cell = cell * static_cast<std::size_t>(count_[k]) + static_cast<std::size_t>(wrapped);
      }
      if (lists_[cell].empty() || lists_[cell].back() != element)
        lists_[cell].push_back(element);
      int k = 0;
      while (k < dim && ++i[k] > to[k]) {
        i[k] = from[k];
        ++k;
      }
      if (k == dim)
        return;
    }
  }

  Period<dim> period_;
  Vec<dim> low_;
  Vec<dim> size_;
  std::array<std::int64_t, dim> count_{};
  std::vector<std::vector<std::uint32_t>> lists_;
};

} // namespace

template <int dim>
std::vector<std::optional<Location<dim>>> locate(const MeshView<dim>& mesh,
                                                 std::span<const double> points) {
  const std::size_t num_points = points.size() / dim;
  std::vector<std::optional<Location<dim>>> found(num_points);
  if (mesh.elements.empty())
    return found;
  const ElementGrid<dim> grid(mesh);
  for (std::size_t p = 0; p < num_points; ++p) {
    const Eigen::Map<const Vec<dim>> point(points.data() + dim * p);
    for (const std::uint32_t e : grid.around(point)) {
      const Corners<dim> x = corner_positions(mesh, e);
      Vec<dim> centre = Vec<dim>::Zero();
      for (const Vec<dim>& corner : x)
        centre += corner / corners<dim>;
      const Vec<dim> image = centre + mesh.period.shortest(point - centre);
      if (const auto shape = inside<dim>(x, image)) {
        found[p] = Location<dim>{e, *shape};
        break;
      }
    }
  }
  return found;
}

template std::vector<std::optional<Location<2>>> locate<2>(const MeshView<2>&,
                                                           std::span<const double>);
template std::vector<std::optional<Location<3>>> locate<3>(const MeshView<3>&,
                                                           std::span<const double>);

} // namespace kerf::coupler
