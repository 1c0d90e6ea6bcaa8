// Rows of nodes: one vector each, aligned as the kernels load them.
#pragma once

#include "common/vec.hpp"
#include "fem_core/kernels/patch_view.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf::fem {

/// A vector in a row of its own; in 3D a fourth number fills it, and is zero.
template <int dim> struct alignas(row_size<dim> * sizeof(double)) Row {
  static constexpr int SizeAtCompileTime = row_size<dim>; // as a small vector of a State
  double x[row_size<dim>] = {};

  double* data() { return x; }
};

/// One vector for every row of Patches.
template <int dim> class Rows {
public:
  Rows() = default;
  explicit Rows(std::size_t size) : rows_(size) {}

  std::size_t size() const { return rows_.size(); }
  double* at(std::size_t row) { return rows_[row].x; }
  const double* at(std::size_t row) const { return rows_[row].x; }
  double* data() { return rows_.empty() ? nullptr : rows_.front().x; }
  const double* data() const { return rows_.empty() ? nullptr : rows_.front().x; }
  Eigen::Map<Vec<dim>> operator[](std::size_t row) { return Eigen::Map<Vec<dim>>(at(row)); }
  Eigen::Map<const Vec<dim>> operator[](std::size_t row) const {
    return Eigen::Map<const Vec<dim>>(at(row));
  }
  void resize(std::size_t size) { rows_.resize(size); }
  void set_zero() { rows_.assign(rows_.size(), {}); }

private:
  friend struct StateParts;

  std::vector<Row<dim>> rows_;
};

} // namespace kerf::fem
