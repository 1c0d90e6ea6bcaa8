#include "dem_core/program/crack_file.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace kerf::dem {

namespace {

template <int dim> std::vector<Column> columns() {
  std::vector<Column> columns = {{"step", "1"}, {"time", "s"}, {"first", "1"}, {"second", "1"}};
  for (const auto& [prefix, unit] : {std::pair{"", "m"}, std::pair{"normal_", "1"}})
    for (int a = 0; a < dim; ++a)
      columns.push_back({prefix + std::string(1, "xyz"[a]), unit});
  columns.insert(columns.end(), {{"mode", "1"}, {"energy", "J"}, {"strength", "N"}});
  return columns;
}

} // namespace

template <int dim>
CrackFile<dim>::CrackFile(const std::filesystem::path& path, std::uint64_t first_step,
                          std::span<const Crack<dim>> before)
    : file_(path, columns<dim>(), first_step), written_(before.size()),
      tension_(static_cast<std::size_t>(
          std::count_if(before.begin(), before.end(), [](const Crack<dim>& crack) {
            return crack.mode == BreakMode::tension;
          }))) {}

template <int dim>
void CrackFile<dim>::write(std::span<const Crack<dim>> all, std::span<const std::uint32_t> ids) {
  for (; written_ < all.size(); ++written_) {
    const Crack<dim>& crack = all[written_];
    // In the file the first particle is the one with the smaller id.
    const bool turned = ids[crack.first] > ids[crack.second];
    const auto [first, second] = std::minmax({ids[crack.first], ids[crack.second]});
    const Vec<dim> normal = turned ? Vec<dim>(-crack.normal) : crack.normal;
    std::vector<double> row = {static_cast<double>(crack.step), crack.time,
                               static_cast<double>(first), static_cast<double>(second)};
    row.insert(row.end(), crack.place.begin(), crack.place.end());
    row.insert(row.end(), normal.begin(), normal.end());
    row.insert(row.end(),
               {crack.mode == BreakMode::tension ? 0.0 : 1.0, crack.energy, crack.strength});
    file_.append(row);
    tension_ += crack.mode == BreakMode::tension ? 1 : 0;
  }
}

template class CrackFile<2>;
template class CrackFile<3>;

} // namespace kerf::dem
