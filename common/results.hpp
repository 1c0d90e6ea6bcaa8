// Frames of a run: the state of one participant at some moments, for ParaView and for reading back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kerf {

/// What joins the points of a grid.
enum class Cells {
  points,    // nothing: one cell for every point, no connectivity
  segments,  // 2 points
  quads,     // 4 points, VTK's order
  hexes,     // 8 points, VTK's order
  triangles, // 3 points
  tetrahedra // 4 points, VTK's order
};

/// One quantity at the points or cells of a grid. The writer does not keep the data.
struct Field {
  std::string name;           // "velocity"
  std::size_t components = 1; // values per point or cell
  std::variant<std::span<const double>, std::span<const std::int64_t>> data; // [count][components]
};

/// Points, what joins them, and quantities on both.
struct Grid {
  std::string name;                  // "particles", "contacts", "mesh"
  std::span<const double> positions; // [num_points][dimension] m
  std::string points_of;             // use the points of this earlier grid; positions stays empty
  Cells cells = Cells::points;
  std::span<const std::uint32_t> connectivity; // [num_cells][points per cell]
  std::vector<Field> point_fields;
  std::vector<Field> cell_fields;
};

/// Writes frames: `frames/<participant>_<step, 9 digits>.h5` and the index `<participant>.xdmf`
/// that ParaView opens. Both get their final names only when complete; the index is replaced after
/// each frame. Files have no time stamps: the same data gives the same bytes.
///
/// In the file a grid is a group. It holds `position` ([num_points][3]), `cells` (when its cells
/// are not points) and one data set per field. In a 2D case positions and fields of two components
/// get a third component of zero, because viewers want vectors of three.
class FrameWriter {
public:
  /// @param dimension   2 or 3, of the positions
  /// @param first_step  other than 0: goes on with the frames before this step; later ones are
  ///                    removed
  FrameWriter(std::filesystem::path run_folder, std::string participant, int dimension,
              std::uint64_t first_step = 0);

  /// @param time  s
  /// @throws std::invalid_argument when an array does not fit its grid; nothing is written then
  /// @throws std::runtime_error when a file cannot be written
  void write(std::uint64_t step, double time, std::span<const Grid> grids);

private:
  void cut(std::uint64_t first_step);
  void write_index() const;

  std::filesystem::path run_folder_;
  std::string participant_;
  std::size_t dimension_;
  std::map<std::uint64_t, std::string> entries_; // of the index, by step
};

/// One data set of a frame.
struct Array {
  std::size_t rows = 0;
  std::size_t columns = 1;
  std::variant<std::vector<double>, std::vector<std::int64_t>> data; // [rows][columns]

  /// @throws std::invalid_argument when the data are of the other type
  const std::vector<double>& reals() const;
  const std::vector<std::int64_t>& integers() const;
};

/// A frame that was read back.
struct Frame {
  std::uint64_t step = 0;
  double time = 0.0;                   // s
  std::map<std::string, Array> arrays; // by "grid/field": "particles/position", "mesh/cells"

  bool has(const std::string& name) const { return arrays.count(name) != 0; }
  /// @throws std::invalid_argument when there is no such array; names those that there are
  const Array& at(const std::string& name) const;
};

/// @throws std::runtime_error when the file is missing or is not a frame
Frame read_frame(const std::filesystem::path& path);

struct FrameFile {
  std::uint64_t step = 0;
  std::filesystem::path path;
};

/// The complete frames of one participant, by step; empty when there are none.
std::vector<FrameFile> list_frames(const std::filesystem::path& run_folder,
                                   std::string_view participant);

} // namespace kerf
