#include "fem_core/stiffness_rows.hpp"

#include "common/instruction_set.hpp"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

namespace kerf {

namespace baseline {
fem::StiffnessKernel stiffness_kernel(int dim);
}
namespace avx2 {
fem::StiffnessKernel stiffness_kernel(int dim);
}
namespace avx512 {
fem::StiffnessKernel stiffness_kernel(int dim);
}

namespace fem {
namespace {

/// All elements of all shapes, numbered through.
template <int dim> class AllElements {
public:
  explicit AllElements(std::span<const StiffnessElements<dim>> shapes) : shapes_(shapes) {
    for (const auto& shape : shapes)
      first_.push_back(first_.back() + shape.rows.size() / static_cast<std::size_t>(shape.corners));
  }

  std::size_t size() const { return first_.back(); }
  std::span<const std::uint32_t> rows(std::size_t element) const {
    const std::size_t s = shape_of(element);
    const auto corners = static_cast<std::size_t>(shapes_[s].corners);
    return shapes_[s].rows.subspan((element - first_[s]) * corners, corners);
  }
  /// @throws std::invalid_argument unless rows of K can be forces of pairs
  ElementMatrix<dim> stiffness(std::size_t element) const {
    const std::size_t s = shape_of(element);
    const ElementMatrix<dim> K = shapes_[s].stiffness(element - first_[s]);
    const double most = 1e-9 * K.cwiseAbs().maxCoeff();
    Eigen::Matrix<double, Eigen::Dynamic, dim, 0, max_dofs<dim>, dim> of_translation =
        K.template leftCols<dim>();
    for (Eigen::Index k = dim; k < K.cols(); k += dim)
      of_translation += K.template middleCols<dim>(k);
    if (!((K - K.transpose()).cwiseAbs().maxCoeff() <= most) ||
        !(of_translation.cwiseAbs().maxCoeff() <= most))
      throw std::invalid_argument(fmt::format(
          "the stiffness of element {} is not symmetric, or resists translation", element));
    return 0.5 * (K + K.transpose()); // to the last bit: forces of pairs are then opposite
  }

private:
  std::size_t shape_of(std::size_t element) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first_, element) - first_.begin()) - 1;
  }

  std::span<const StiffnessElements<dim>> shapes_;
  std::vector<std::size_t> first_{0};
};

/// The elements around each row, ascending.
struct ElementsOfRows {
  std::vector<std::size_t> first; // [rows + 1]
  std::vector<std::uint32_t> elements;

  template <int dim> ElementsOfRows(const AllElements<dim>& all, std::size_t num_rows) {
    first.assign(num_rows + 1, 0);
    for (std::size_t e = 0; e < all.size(); ++e)
      for (const std::uint32_t row : all.rows(e)) {
        if (row >= num_rows)
          throw std::invalid_argument(fmt::format("element {} has row {} of {}", e, row, num_rows));
        ++first[row + 1];
      }
    for (std::size_t row = 0; row < num_rows; ++row)
      first[row + 1] += first[row];
    elements.resize(first.back());
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (std::size_t e = 0; e < all.size(); ++e)
      for (const std::uint32_t row : all.rows(e))
        elements[next[row]++] = static_cast<std::uint32_t>(e);
  }
};

/// The pairs of one block.
template <int dim> class BlockPairs {
public:
  using Matrix = Eigen::Matrix<double, dim, dim>;
  struct Pair {
    std::uint32_t row, other;
    Matrix K = Matrix::Zero();
    double size = 0.0; // sum of the largest numbers that K is the sum of
  };

  BlockPairs(const AllElements<dim>& all, const ElementsOfRows& around, std::size_t first_row,
             std::size_t end_row)
      : first_row_(first_row), end_row_(end_row) {
    const auto begin = around.elements.begin();
    std::vector<std::uint32_t> elements(begin +
                                            static_cast<std::ptrdiff_t>(around.first[first_row]),
                                        begin + static_cast<std::ptrdiff_t>(around.first[end_row]));
    std::ranges::sort(elements);
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    for (const std::uint32_t e : elements)
      for_pairs(all.rows(e), [&](std::uint32_t row, std::uint32_t other, std::size_t, std::size_t) {
        keys_.push_back(key(row, other));
      });
    std::ranges::sort(keys_);
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    for (const std::uint64_t k : keys_)
      pairs_.push_back({static_cast<std::uint32_t>(k >> 32), static_cast<std::uint32_t>(k)});
    for (const std::uint32_t e : elements) {
      const ElementMatrix<dim> K = all.stiffness(e);
      for_pairs(all.rows(e),
                [&](std::uint32_t row, std::uint32_t other, std::size_t a, std::size_t b) {
                  const auto at = std::ranges::lower_bound(keys_, key(row, other)) - keys_.begin();
                  Pair& pair = pairs_[static_cast<std::size_t>(at)];
                  const Matrix part = K.template block<dim, dim>(
                      static_cast<Eigen::Index>(a) * dim, static_cast<Eigen::Index>(b) * dim);
                  pair.K += part;
                  pair.size += part.cwiseAbs().maxCoeff();
                });
    }
  }

  const std::vector<Pair>& pairs() const { return pairs_; } // by row, then by the other

  PairKind kind_of(const Pair& pair) const {
    constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();
    return {.inside = is_inside(pair.other),
            .symmetric =
                (pair.K - pair.K.transpose()).cwiseAbs().maxCoeff() <= rounding * pair.size};
  }

private:
  static std::uint64_t key(std::uint32_t row, std::uint32_t other) {
    return std::uint64_t{row} << 32 | other;
  }
  bool is_inside(std::uint32_t row) const { return row >= first_row_ && row < end_row_; }

  /// Calls act(row, other, corner of row, corner of other) for the pairs that the block stores.
  template <class Act> void for_pairs(std::span<const std::uint32_t> corners, Act act) const {
    for (std::size_t a = 0; a < corners.size(); ++a)
      for (std::size_t b = 0; b < corners.size(); ++b) {
        const std::uint32_t row = corners[a], other = corners[b];
        if (is_inside(row) && row != other && (row < other || !is_inside(other)))
          act(row, other, a, b);
      }
  }

  std::size_t first_row_, end_row_;
  std::vector<std::uint64_t> keys_;
  std::vector<Pair> pairs_;
};

} // namespace

template <int dim> class StiffnessAssembly {
public:
  explicit StiffnessAssembly(StiffnessRows<dim>& rows) : rows_(rows) {}

  void add_block(const BlockPairs<dim>& pairs, std::size_t first_row, std::size_t end_row) {
    typename StiffnessRows<dim>::Block block{.first_row = static_cast<std::uint32_t>(first_row),
                                             .num_rows =
                                                 static_cast<std::uint32_t>(end_row - first_row),
                                             .num_slices = {},
                                             .first_slice = rows_.lengths_.size(),
                                             .first_inside = rows_.inside_.size(),
                                             .first_outside = rows_.outside_.size(),
                                             .first_matrix = rows_.matrices_.size()};
    for (std::size_t k = 0; k < num_pair_kinds; ++k) {
      const std::size_t before = rows_.lengths_.size();
      add_kind(pairs, pair_kinds[k], block.first_row);
      block.num_slices[k] = static_cast<std::uint32_t>(rows_.lengths_.size() - before);
    }
    rows_.blocks_.push_back(block);
  }

private:
  using Pair = typename BlockPairs<dim>::Pair;
  using PairsOfRow = std::vector<const Pair*>; // never empty

  /// Where a row of the block begins.
  static std::uint16_t place(std::uint32_t row) {
    return static_cast<std::uint16_t>(row * row_size<dim>);
  }

  void add_kind(const BlockPairs<dim>& pairs, PairKind kind, std::uint32_t first_row) {
    std::vector<PairsOfRow> of_rows;
    for (const Pair& pair : pairs.pairs()) {
      const PairKind its = pairs.kind_of(pair);
      if (its.inside != kind.inside || its.symmetric != kind.symmetric)
        continue;
      if (of_rows.empty() || of_rows.back().front()->row != pair.row)
        of_rows.emplace_back();
      of_rows.back().push_back(&pair);
    }
    std::ranges::stable_sort(of_rows, std::greater(), &PairsOfRow::size); // little is filled up
    for (std::size_t first = 0; first < of_rows.size(); first += batch_size)
      add_slice(std::span(of_rows).subspan(
                    first, std::min<std::size_t>(batch_size, of_rows.size() - first)),
                kind, first_row);
  }

  void add_slice(std::span<const PairsOfRow> of_rows, PairKind kind, std::uint32_t first_row) {
    const auto row_of = [&](std::size_t lane) {
      return of_rows[lane < of_rows.size() ? lane : 0].front()->row;
    };
    for (std::size_t lane = 0; lane < batch_size; ++lane)
      rows_.rows_.push_back(place(row_of(lane) - first_row));
    const std::size_t length = of_rows.front().size();
    rows_.lengths_.push_back(static_cast<std::uint16_t>(length));
    for (std::size_t k = 0; k < length; ++k) {
      const std::size_t first_matrix = rows_.matrices_.size();
      rows_.matrices_.resize(first_matrix + pair_numbers(dim, kind.symmetric));
      for (std::size_t lane = 0; lane < batch_size; ++lane) {
        const bool is_there = lane < of_rows.size() && k < of_rows[lane].size();
        const std::uint32_t other = is_there ? of_rows[lane][k]->other : row_of(lane);
        if (kind.inside)
          rows_.inside_.push_back(place(other - first_row));
        else
          rows_.outside_.push_back(other);
        if (is_there)
          set(&rows_.matrices_[first_matrix], lane, of_rows[lane][k]->K, kind.symmetric);
      }
    }
  }

  static void set(PairNumbers* numbers, std::size_t lane, const typename BlockPairs<dim>::Matrix& K,
                  bool symmetric) {
    const auto put = [&](double number) { (numbers++)->of_lane[lane] = number; };
    if (!symmetric) {
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          put(K(i, j));
      return;
    }
    for (int i = 0; i < dim; ++i)
      put(K(i, i));
    for (int i = dim - 2; i >= 0; --i)
      for (int j = dim - 1; j > i; --j)
        put(0.5 * (K(i, j) + K(j, i)));
  }

  StiffnessRows<dim>& rows_;
};

template <int dim>
StiffnessRows<dim>::StiffnessRows(std::size_t num_rows,
                                  std::span<const StiffnessElements<dim>> elements)
    : num_rows_(num_rows), kernel_(dispatch(baseline::stiffness_kernel, avx2::stiffness_kernel,
                                            avx512::stiffness_kernel)(dim)) {
  const AllElements<dim> all(elements);
  const ElementsOfRows around(all, num_rows);
  StiffnessAssembly<dim> assembly(*this);
  for (std::size_t first = 0; first < num_rows; first += rows_per_block) {
    const std::size_t end = std::min(first + rows_per_block, num_rows);
    assembly.add_block(BlockPairs<dim>(all, around, first, end), first, end);
  }
  inside_.shrink_to_fit();
  outside_.shrink_to_fit();
  matrices_.shrink_to_fit();
}

template <int dim> std::size_t StiffnessRows<dim>::bytes() const {
  return blocks_.size() * sizeof(Block) + (rows_.size() + lengths_.size() + inside_.size()) * 2 +
         outside_.size() * 4 + matrices_.size() * sizeof(PairNumbers);
}

template <int dim> void StiffnessRows<dim>::multiply(const double* u, double* f) const {
  const auto count = static_cast<std::int64_t>(blocks_.size());
#pragma omp parallel for schedule(static) if (count > 1)
  for (std::int64_t b = 0; b < count; ++b) {
    const Block& block = blocks_[static_cast<std::size_t>(b)];
    compute(block, u, f + std::size_t{block.first_row} * row_size<dim>);
  }
}

template <int dim>
void StiffnessRows<dim>::compute(const Block& block, const double* u, double* f) const {
  kernel_({.first_row = block.first_row,
           .num_rows = block.num_rows,
           .num_slices = block.num_slices.data(),
           .rows = rows_.data() + block.first_slice * batch_size,
           .lengths = lengths_.data() + block.first_slice,
           .inside = inside_.data() + block.first_inside,
           .outside = outside_.data() + block.first_outside,
           .matrices = matrices_.data() + block.first_matrix,
           .displacement = u,
           .force = f});
}

template class StiffnessRows<2>;
template class StiffnessRows<3>;

} // namespace fem
} // namespace kerf
