// The keys of "participants.*.mesh": a generator of elements or a file.
#include "common/config/schema_rows.hpp"

namespace kerf::config {

std::vector<Key> element_keys() {
  using enum Type;
  return {
      {"participants.*.mesh", "fem", table, "", tables, anything, "mesh", "the elements"},
      {"participants.*.mesh.type", "fem", text, "", R"("box")",
       one_of({"box", "bar", "disc", "cylinder", "ring", "tunnel", "file"}), R"("box")",
       "the kind of mesh; the user guide has the keys and the tags of each"},
      {"participants.*.mesh.shape", "fem", text, "", none,
       one_of({"tri3", "quad4", "tet4", "hex8"}), R"("quad4")",
       "the elements: quad4 or tri3 in 2D, hex8 or tet4 in 3D; quad4 and hex8 when not given"},
      {"participants.*.mesh.origin", "fem", vector, "m", none, anything, "[0.06975, 0.0]",
       "the lower corner of a box, a bar, or the block around a tunnel", live},
      {"participants.*.mesh.size", "fem", vector, "m", none, in(above_zero),
       "[0.08, 0.006928203230275509]", "the length of each of its sides", live},
      {"participants.*.mesh.count", "fem", counts, "", none, in(from_one), "[80, 7]",
       "the number of elements: of a box along each axis; of round meshes along the radius, "
       "around, "
       "and in 3D along z",
       live},
      {"participants.*.mesh.elements", "fem", integer, "", none, in(from_one), "80",
       "the number of elements of a bar, all along x"},
      {"participants.*.mesh.grading", "fem", vector, "", none, in(above_zero), "[4.0, 1.0]",
       "of a box, along each axis, the size of the last element over that of the first"},
      {"participants.*.mesh.center", "fem", vector, "m", none, anything, "[0.0, 0.0]",
       "the middle of a disc or a ring, in 3D of its lower end; of a tunnel when it is not that of "
       "its block"},
      {"participants.*.mesh.radius", "fem", number, "m", none, in(above_zero), "3.2e-3",
       "the radius of a disc, a cylinder, a ring or a tunnel"},
      {"participants.*.mesh.inner_radius", "fem", number, "m", none, in(above_zero), "1e-3",
       "the inner radius of a ring"},
      {"participants.*.mesh.length", "fem", number, "m", none, in(above_zero), "32.4e-3",
       "the length of a cylinder, or in 3D of a ring, along z"},
      {"participants.*.mesh.radial_grading", "fem", number, "", none, in(above_zero), "8.0",
       "of a ring or a tunnel, the radial size of the outermost element over that of the "
       "innermost"},
      {"participants.*.mesh.excavation", "fem", flag, "", none, anything, "true",
       "true for elements in the opening of a tunnel, too, as the region excavation"},
      {"participants.*.mesh.file", "fem", path, "", none, anything, R"("rock.msh")",
       "a mesh (.msh of Gmsh) or a geometry to be meshed (.geo, .step)"},
      {"participants.*.mesh.scale", "fem", number, "", none, in(above_zero), "1e-3",
       "the factor of the coordinates in the file, 1e-3 for millimetres; 1 when not given"},
      {"participants.*.mesh.element_size", "fem", number, "m", none, in(above_zero), "1e-3",
       "the largest size of the elements that a geometry is meshed with"},
  };
}

} // namespace kerf::config
