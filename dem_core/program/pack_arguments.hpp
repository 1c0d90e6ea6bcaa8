// Regions and radii as words of the command line.
#pragma once

#include "dem_core/packing/radii.hpp"
#include "dem_core/packing/region.hpp"

#include <memory>
#include <stdexcept>
#include <string>

namespace kerf::dem {

/// An argument of `kerf pack` that cannot be used; what() names it and says what to write.
class ArgumentError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Ways to write a region; numbers in m, the path to the end of the word.
inline constexpr const char* region_words =
    "box:x,y[,z],x,y[,z] (corners), disc:x,y,radius, sphere:x,y,z,radius, "
    "cylinder:x,y,z,x,y,z,radius (ends) or surface:FILE (.stl in 3D, else lines x y of a polygon)";

/// Ways to write radii; numbers in m.
inline constexpr const char* radii_words =
    "uniform:least,most, power:least,most,exponent (density ~ r^-exponent) or "
    "list:radius[*weight],...";

/// The dimension that a region is of.
/// @throws ArgumentError
int dimension_of_region(const std::string& word);

/// @param periodic  axes without a wall, of a box: "", "x", "xy"…
/// @throws ArgumentError
template <int dim>
std::unique_ptr<Region<dim>> read_region(const std::string& word, const std::string& periodic = "");

/// @throws ArgumentError
Radii read_radii(const std::string& word);

} // namespace kerf::dem
