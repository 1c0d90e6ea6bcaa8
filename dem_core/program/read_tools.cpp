#include "dem_core/program/read_tools.hpp"

#include "common/surface_file.hpp"
#include "dem_core/program/read_table.hpp"

#include <stdexcept>

namespace kerf::dem {

namespace {

/// Faces of a box, seen from outside.
template <int dim> Surface<dim> box_surface(const Box<dim>& box) {
  Surface<dim> surface;
  for (int corner = 0; corner < 1 << dim; ++corner) { // bit a: on the upper side of axis a
    Vec<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = (corner >> a & 1) != 0 ? box.upper[a] : box.lower[a];
    surface.vertices.push_back(x);
  }
  if constexpr (dim == 2)
    surface.facets = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};
  else
    surface.facets = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return surface;
}

template <int dim> Surface<dim> read_scaled_surface(const Node& tool) {
  const Node file = tool["file"], tag = tool["tag"];
  try {
    Surface<dim> surface = read_surface<dim>(file.text(), tag.is_null() ? "" : tag.text());
    for (Vec<dim>& vertex : surface.vertices)
      vertex *= tool["scale"].is_null() ? 1.0 : tool["scale"].positive();
    return surface;
  } catch (const FileError& error) {
    (tag.is_null() ? file : tag).fail(error.what(), "correct the file, or name another surface");
  }
}

template <int dim> ToolShape<dim> read_shape(const Node& tool) {
  const std::string shape = tool["shape"].text();
  try {
    if (shape == "plane")
      return ToolShape<dim>(Plane<dim>{tool["point"].vector<dim>(), tool["normal"].vector<dim>()});
    if (shape == "box")
      return ToolShape<dim>(box_surface(tool["box"].box<dim>()));
    if (shape == "file")
      return ToolShape<dim>(read_scaled_surface<dim>(tool));
  } catch (const std::invalid_argument& error) {
    tool[shape == "plane" ? "normal" : shape].fail(
        error.what(), shape == "plane" ? "give the direction from the solid to the particles"
                                       : "let the surface extend along every axis");
  }
  tool["shape"].fail(fmt::format("\"{}\" must be one of box, file, plane", shape));
}

/// The reference point when none is given: the middle, or the point of a plane.
template <int dim> Vec<dim> middle(const Node& tool, const ToolShape<dim>& shape) {
  if (const Surface<dim>* surface = shape.surface()) {
    const Box<dim> box = bounding_box(*surface);
    return 0.5 * (box.lower + box.upper);
  }
  return tool["point"].vector<dim>();
}

template <int dim> FreeTranslation<dim> read_free(const Node& node) {
  FreeTranslation<dim> free;
  for (std::size_t k = 0; k < node["axes"].size(); ++k)
    free.axes[static_cast<std::size_t>(node["axes"][k].axis<dim>())] = true;
  free.mass = node["mass"].positive();
  free.force = node["force"].vector_or_zero<dim>();
  return free;
}

} // namespace

template <int dim>
ToolMotion<dim> read_motion(const Node& tool, const Vec<dim>& reference, const Rot<dim>& axis) {
  ToolMotion<dim> motion;
  motion.reference = reference;
  motion.axis = axis;
  const Vec<dim> velocity = tool["velocity"].vector_or_zero<dim>();
  const Node velocities = tool["velocities"];
  for (std::size_t a = 0; a < dim; ++a)
    motion.velocity[a] = velocities.is_null() ? TimeTable(velocity[static_cast<int>(a)])
                                              : read_table(velocities, a + 1);
  if (const Node rotation = tool["rotation"]; !rotation.is_null()) {
    motion.rotation_rate = read_value_or_table(rotation["rate"], rotation["rates"]);
    if constexpr (dim == 3)
      if (!rotation["axis"].is_null())
        motion.axis = rotation["axis"].vector<3>();
  }
  if (const Node servo = tool["servo"]; !servo.is_null())
    motion.servo = Servo<dim>{servo["direction"].vector<dim>(),
                              read_value_or_table(servo["force"], servo["forces"]),
                              servo["max_velocity"].positive()};
  if (const Node free = tool["free"]; !free.is_null())
    motion.free_translation = read_free<dim>(free);
  if (const Node free = tool["free_rotation"]; !free.is_null())
    motion.free_rotation = FreeRotation{free["inertia"].positive(), free["moment"].number_or(0.0)};
  try {
    ToolMover<dim>{motion};
  } catch (const std::invalid_argument& error) {
    tool.fail(error.what(), "let each direction have one motion, and give directions a length");
  }
  return motion;
}

namespace {

template <int dim> ToolSettings<dim> read_tool(const Node& tool) {
  ToolShape<dim> shape = read_shape<dim>(tool);
  const Node reference = tool["reference"];
  ToolMotion<dim> motion =
      read_motion<dim>(tool, reference.is_null() ? middle(tool, shape) : reference.vector<dim>(),
                       ToolMotion<dim>().axis);
  return {tool["name"].text(), std::move(shape), std::move(motion),
          WallMaterial{.normal_stiffness = tool["normal_stiffness"].positive(),
                       .tangential_stiffness = tool["tangential_stiffness"].not_negative_or(0.0),
                       .friction = tool["friction"].not_negative_or(0.0),
                       .seated = tool["seated"].flag()}};
}

} // namespace

template <int dim> std::vector<ToolSettings<dim>> read_tools(const Node& list) {
  std::vector<ToolSettings<dim>> tools;
  for (std::size_t k = 0; k < list.size(); ++k)
    tools.push_back(read_tool<dim>(list[k]));
  return tools;
}

template ToolMotion<2> read_motion<2>(const Node&, const Vec<2>&, const Rot<2>&);
template ToolMotion<3> read_motion<3>(const Node&, const Vec<3>&, const Rot<3>&);
template std::vector<ToolSettings<2>> read_tools<2>(const Node&);
template std::vector<ToolSettings<3>> read_tools<3>(const Node&);

} // namespace kerf::dem
