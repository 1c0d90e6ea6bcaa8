#include "dem_core/packing/region.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace kerf::dem {

namespace {

void check_length(double length, const char* what) {
  if (!(length > 0.0) || !std::isfinite(length))
    throw std::invalid_argument(fmt::format("the {} of {} m must be positive", what, length));
}

} // namespace

template <int dim>
BoxRegion<dim>::BoxRegion(const Box<dim>& box, const std::array<bool, dim>& periodic) : box_(box) {
  for (int a = 0; a < dim; ++a) {
    const double length = box.upper[a] - box.lower[a];
    check_length(length, "side of a box");
    if (periodic[static_cast<std::size_t>(a)])
      period_.length[a] = length;
  }
}

template <int dim> Wall<dim> BoxRegion<dim>::wall(const Vec<dim>& point) const {
  Wall<dim> nearest{.depth = std::numeric_limits<double>::infinity(), .inward = Vec<dim>::Zero()};
  for (int a = 0; a < dim; ++a) {
    if (period_.length[a] > 0.0)
      continue;
    const double above_lower = point[a] - box_.lower[a], below_upper = box_.upper[a] - point[a];
    const double depth = std::min(above_lower, below_upper);
    if (depth < nearest.depth)
      nearest = {depth, (above_lower < below_upper ? 1.0 : -1.0) * Vec<dim>::Unit(a)};
  }
  return nearest;
}

template <int dim>
Ball<dim>::Ball(const Vec<dim>& center, double radius) : center_(center), radius_(radius) {
  check_length(radius, dim == 2 ? "radius of a disc" : "radius of a sphere");
}

template <int dim> double Ball<dim>::volume() const {
  return dim == 2 ? std::numbers::pi * radius_ * radius_
                  : 4.0 / 3.0 * std::numbers::pi * radius_ * radius_ * radius_;
}

template <int dim> Box<dim> Ball<dim>::bounds() const {
  const Vec<dim> half = Vec<dim>::Constant(radius_);
  return {center_ - half, center_ + half};
}

template <int dim> Wall<dim> Ball<dim>::wall(const Vec<dim>& point) const {
  const Vec<dim> arm = point - center_;
  const double distance = arm.norm();
  return {radius_ - distance,
          distance > 0.0 ? Vec<dim>(-arm / distance) : Vec<dim>(Vec<dim>::UnitX())};
}

Cylinder::Cylinder(const Vec<3>& bottom, const Vec<3>& top, double radius)
    : bottom_(bottom), axis_((top - bottom).normalized()), length_((top - bottom).norm()),
      radius_(radius) {
  check_length(length_, "length of a cylinder");
  check_length(radius, "radius of a cylinder");
}

double Cylinder::volume() const {
  return std::numbers::pi * radius_ * radius_ * length_;
}

Box<3> Cylinder::bounds() const {
  const Vec<3> top = bottom_ + length_ * axis_;
  const Vec<3> half = radius_ * (1.0 - axis_.array().square()).max(0.0).sqrt(); // of an end disc
  return {bottom_.cwiseMin(top) - half, bottom_.cwiseMax(top) + half};
}

Wall<3> Cylinder::wall(const Vec<3>& point) const {
  const double height = (point - bottom_).dot(axis_);
  const Vec<3> arm = point - bottom_ - height * axis_;
  const double distance = arm.norm();
  const double to_mantle = radius_ - distance, to_end = std::min(height, length_ - height);
  if (to_end < to_mantle)
    return {to_end, (height < length_ - height ? 1.0 : -1.0) * axis_};
  return {to_mantle, distance > 0.0 ? Vec<3>(-arm / distance) : axis_.unitOrthogonal()};
}

template class BoxRegion<2>;
template class BoxRegion<3>;
template class Ball<2>;
template class Ball<3>;

} // namespace kerf::dem
