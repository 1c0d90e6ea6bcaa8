// Checks of the parameters of material laws.
#pragma once

namespace kerf::fem {

/// @param key  of the settings, for example "material.density"
/// @throws InputError unless the value is positive and finite
void check_positive(const char* key, double value, const char* unit);

/// @throws InputError unless the value is finite and not negative
void check_not_negative(const char* key, double value, const char* unit);

} // namespace kerf::fem
