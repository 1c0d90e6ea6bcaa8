// When a loop is worth the threads.
#pragma once

#include <cstdint>

namespace kerf::fem {

/// Shorter loops are done before the other threads have woken up.
inline constexpr std::int64_t least_parallel_size = 500;

} // namespace kerf::fem
