#include "dem_core/program/pack_arguments.hpp"

#include "common/surface_file.hpp"
#include "dem_core/packing/closed_surface.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::dem {

namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos)
      return parts;
    text.remove_prefix(end + 1);
  }
}

double read_number(std::string_view text, const std::string& word) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw ArgumentError(fmt::format("{}: \"{}\" is not a finite number", word, text));
  return value;
}

std::vector<double> read_numbers(std::string_view text, const std::string& word) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ','))
    numbers.push_back(read_number(part, word));
  return numbers;
}

/// What stands before and after the colon.
std::pair<std::string, std::string> parts_of(const std::string& word) {
  const auto colon = word.find(':');
  return {word.substr(0, colon), colon == std::string::npos ? "" : word.substr(colon + 1)};
}

[[noreturn]] void refuse_region(const std::string& word) {
  throw ArgumentError(fmt::format("{} is not a region; write {}", word, region_words));
}

template <int dim> Vec<dim> vector_at(const std::vector<double>& numbers, std::size_t first) {
  return Eigen::Map<const Vec<dim>>(numbers.data() + first);
}

template <int dim> std::unique_ptr<Region<dim>> read_closed_surface(const std::string& path) {
  Surface<dim> surface = read_surface<dim>(path);
  if constexpr (dim == 2) // the last corner of a polygon is joined to the first
    if (surface.facets.back()[1] != surface.facets.front()[0])
      surface.facets.push_back({surface.facets.back()[1], surface.facets.front()[0]});
  try {
    return std::make_unique<ClosedSurface<dim>>(std::move(surface.vertices),
                                                std::move(surface.facets));
  } catch (const std::invalid_argument& error) {
    throw ArgumentError(fmt::format("{}: {}", path, error.what()));
  }
}

template <int dim>
std::unique_ptr<Region<dim>> read_body(const std::string& word, const std::string& periodic) {
  const auto [shape, rest] = parts_of(word);
  if (shape == "surface")
    return read_closed_surface<dim>(rest);
  const std::vector<double> n = read_numbers(rest, word);
  if (shape == "box" && n.size() == 2 * dim) {
    std::array<bool, dim> repeats{};
    for (std::size_t a = 0; a < dim; ++a)
      repeats[a] = periodic.find("xyz"[a]) != std::string::npos;
    return std::make_unique<BoxRegion<dim>>(Box<dim>{vector_at<dim>(n, 0), vector_at<dim>(n, dim)},
                                            repeats);
  }
  if (shape == (dim == 2 ? "disc" : "sphere") && n.size() == dim + 1)
    return std::make_unique<Ball<dim>>(vector_at<dim>(n, 0), n[dim]);
  if constexpr (dim == 3)
    if (shape == "cylinder" && n.size() == 7)
      return std::make_unique<Cylinder>(vector_at<3>(n, 0), vector_at<3>(n, 3), n[6]);
  refuse_region(word);
}

} // namespace

int dimension_of_region(const std::string& word) {
  const auto [shape, rest] = parts_of(word);
  if (shape == "surface")
    return std::filesystem::path(rest).extension() == ".stl" ? 3 : 2;
  if (shape == "box")
    return split(rest, ',').size() == 4 ? 2 : 3;
  if (shape == "disc")
    return 2;
  if (shape == "sphere" || shape == "cylinder")
    return 3;
  refuse_region(word);
}

template <int dim>
std::unique_ptr<Region<dim>> read_region(const std::string& word, const std::string& periodic) {
  if (dimension_of_region(word) != dim)
    throw ArgumentError(fmt::format("{} is not a region in {}D", word, dim));
  const std::string axes = dim == 2 ? "xy" : "xyz";
  if (periodic.find_first_not_of(axes) != std::string::npos ||
      (!periodic.empty() && !word.starts_with("box:")))
    throw ArgumentError(fmt::format("\"{}\" must be axes of a box, some of {}", periodic, axes));
  try {
    return read_body<dim>(word, periodic);
  } catch (const std::invalid_argument& error) {
    throw ArgumentError(fmt::format("{}: {}", word, error.what()));
  } catch (const FileError& error) {
    throw ArgumentError(error.what());
  }
}

Radii read_radii(const std::string& word) {
  const auto [law, rest] = parts_of(word);
  Radii radii;
  if (law == "list") {
    radii.law = RadiusLaw::list;
    for (const std::string_view part : split(rest, ',')) {
      const auto factors = split(part, '*');
      radii.values.push_back(read_number(factors.front(), word));
      radii.weights.push_back(factors.size() > 1 ? read_number(factors[1], word) : 1.0);
    }
    return radii;
  }
  const std::size_t wanted = law == "uniform" ? 2 : law == "power" ? 3 : 0;
  const std::vector<double> numbers = wanted > 0 ? read_numbers(rest, word) : std::vector<double>();
  if (wanted == 0 || numbers.size() != wanted)
    throw ArgumentError(fmt::format("{} are not radii; write {}", word, radii_words));
  radii.law = law == "uniform" ? RadiusLaw::uniform : RadiusLaw::power;
  radii.least = numbers[0];
  radii.most = numbers[1];
  radii.exponent = law == "power" ? numbers[2] : 0.0;
  return radii;
}

template std::unique_ptr<Region<2>> read_region<2>(const std::string&, const std::string&);
template std::unique_ptr<Region<3>> read_region<3>(const std::string&, const std::string&);

} // namespace kerf::dem
