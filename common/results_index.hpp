// The index of frames that ParaView opens: XDMF, version 3.
#pragma once

#include "common/results.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace kerf {

/// A grid with its sizes, and where in the file its points are.
struct Layout {
  const Grid* grid = nullptr;
  std::string position; // "particles/position"
  std::size_t num_points = 0;
  std::size_t num_cells = 0;
  std::size_t corners = 1; // points of a cell
};

std::size_t points_per_cell(Cells cells);

/// What the index says of one frame. Grids without cells are left out; viewers trip over them.
/// @param file  the frame, relative to the index
std::string index_entry(const std::string& file, std::uint64_t step, double time,
                        const std::vector<Layout>& layouts, std::size_t dimension);

/// @param entries  by step
std::string index_text(const std::string& participant,
                       const std::map<std::uint64_t, std::string>& entries);

/// The entries of an index that index_text() made.
std::map<std::uint64_t, std::string> read_index(const std::string& text);

} // namespace kerf
