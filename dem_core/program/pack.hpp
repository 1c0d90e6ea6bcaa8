// kerf-dem pack - makes, cuts, converts and measures packings.
#pragma once

namespace kerf::dem {

/// The verb with its arguments, the program's name being the first two.
/// @return exit code
int run_pack(int count, const char* const* arguments);

} // namespace kerf::dem
