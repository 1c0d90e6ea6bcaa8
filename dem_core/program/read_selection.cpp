#include "dem_core/program/read_selection.hpp"

#include "common/text_file.hpp"

#include <cmath>

namespace kerf::dem {

std::vector<std::uint32_t> read_ids(const Node& node) {
  std::vector<std::uint32_t> ids;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const double id = node[k].number();
    if (!(id >= 0.0) || id != std::floor(id) || id > 4e9)
      node[k].fail(fmt::format("{} is not the id of a particle", id), "give whole numbers from 0");
    ids.push_back(static_cast<std::uint32_t>(id));
  }
  return ids;
}

std::map<double, std::vector<std::uint32_t>> read_groups(const Node& node, std::size_t particles) {
  std::map<double, std::vector<std::uint32_t>> members;
  std::uint32_t line = 0;
  try {
    TextFile file(node.text(), '#');
    for (; file.next(); ++line) {
      const double number = file.number(file.words().size() - 1);
      if (number != std::floor(number))
        file.fail(fmt::format("{} is not a whole number", number));
      if (number >= 0.0)
        members[number].push_back(line);
    }
  } catch (const FileError& error) {
    node.fail(error.what(), "correct the file, or name another one");
  }
  if (line != particles)
    node.fail(fmt::format("it has {} lines for {} particles", line, particles),
              "give one line for each particle, in their order");
  return members;
}

} // namespace kerf::dem
