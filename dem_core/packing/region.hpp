// Parts of space with a wall around them, to be filled with particles or to be cut out.
#pragma once

#include "common/vec.hpp"

#include <array>

namespace kerf::dem {

/// Where the wall is, seen from a point.
template <int dim> struct Wall {
  double depth = 0.0;                 // distance to the wall; negative outside, m
  Vec<dim> inward = Vec<dim>::Zero(); // unit normal at the nearest point of the wall
};

template <int dim> class Region {
public:
  virtual ~Region() = default;

  virtual double volume() const = 0;   // m³, in 2D m²
  virtual Box<dim> bounds() const = 0; // the box around it

  /// The wall that is nearest to a point.
  virtual Wall<dim> wall(const Vec<dim>& point) const = 0;

  /// Axes along which the region repeats itself and has no wall.
  virtual Period<dim> period() const { return {}; }

  bool contains(const Vec<dim>& point) const { return wall(point).depth >= 0.0; }
};

/// A box; along its periodic axes it has no wall.
template <int dim> class BoxRegion final : public Region<dim> {
public:
  /// @throws std::invalid_argument when the box has no volume
  explicit BoxRegion(const Box<dim>& box, const std::array<bool, dim>& periodic = {});

  double volume() const override { return (box_.upper - box_.lower).prod(); }
  Box<dim> bounds() const override { return box_; }
  Wall<dim> wall(const Vec<dim>& point) const override;
  Period<dim> period() const override { return period_; }

private:
  Box<dim> box_;
  Period<dim> period_;
};

/// A disc in 2D, a sphere in 3D.
template <int dim> class Ball final : public Region<dim> {
public:
  /// @throws std::invalid_argument when the radius (m) is not positive
  Ball(const Vec<dim>& center, double radius);

  double volume() const override;
  Box<dim> bounds() const override;
  Wall<dim> wall(const Vec<dim>& point) const override;

private:
  Vec<dim> center_;
  double radius_;
};

/// A cylinder around any axis, with flat ends.
class Cylinder final : public Region<3> {
public:
  /// @param bottom, top  centres of the ends, m
  /// @throws std::invalid_argument when the length or the radius (m) is not positive
  Cylinder(const Vec<3>& bottom, const Vec<3>& top, double radius);

  double volume() const override;
  Box<3> bounds() const override;
  Wall<3> wall(const Vec<3>& point) const override;

private:
  Vec<3> bottom_, axis_; // axis_: unit vector towards the top
  double length_, radius_;
};

} // namespace kerf::dem
