#include "common/packing_file.hpp"

#include <fmt/format.h>

namespace kerf {

Packing read_packing(const std::filesystem::path& path, int dim) {
  TextFile file(path, '#');
  Packing packing;
  const auto columns = static_cast<std::size_t>(dim);
  while (file.next()) {
    if (file.words().size() != columns + 1)
      file.fail(fmt::format("a line must hold {} values, {}, but this one holds {}", dim + 1,
                            dim == 2 ? "x y r" : "x y z r", file.words().size()));
    for (std::size_t a = 0; a < columns; ++a)
      packing.positions.push_back(file.number(a));
    const double radius = file.number(columns);
    if (!(radius > 0.0))
      file.fail(fmt::format("the radius {} m must be positive", radius));
    packing.radii.push_back(radius);
  }
  if (packing.radii.empty())
    throw PackingError(fmt::format("{} holds no particle", path.string()));
  return packing;
}

} // namespace kerf
