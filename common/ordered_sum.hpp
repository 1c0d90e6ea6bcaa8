// A sum over many items that gives the same bits for any number of threads.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace kerf {

/// Sums term(0) + … + term(count − 1). The terms are cut into blocks of a fixed size, never of the
/// number of threads; the blocks are summed in parallel and then added in their order.
template <class Term> auto ordered_sum(std::size_t count, Term term) -> decltype(term(0)) {
  using Value = decltype(term(0));
  constexpr std::size_t block = 1024;
  const auto blocks = static_cast<std::int64_t>((count + block - 1) / block);
  std::vector<Value> partial(static_cast<std::size_t>(blocks), Value{});
#pragma omp parallel for schedule(static) if (blocks > 1)
  for (std::int64_t b = 0; b < blocks; ++b) {
    Value sum{};
    const std::size_t end = std::min(count, static_cast<std::size_t>(b + 1) * block);
    for (std::size_t i = static_cast<std::size_t>(b) * block; i < end; ++i)
      sum += term(i);
    partial[static_cast<std::size_t>(b)] = sum;
  }
  Value total{};
  for (const Value& sum : partial)
    total += sum;
  return total;
}

} // namespace kerf
