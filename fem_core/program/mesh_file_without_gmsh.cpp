// What is said of mesh files when kerf was built without the Gmsh library.
#include "fem_core/input_error.hpp"
#include "fem_core/program/mesh_file.hpp"

namespace kerf::fem {

template <int dim> Mesh<dim> read_mesh_file(const MeshFile& file) {
  throw InputError("mesh.file", file.path.string() +
                                    " is read with the Gmsh library, which this kerf was built "
                                    "without. Install its Debian package, apt-get install "
                                    "libgmsh-dev, then configure and build kerf again with "
                                    "-DKERF_GMSH=ON");
}

template Mesh<2> read_mesh_file<2>(const MeshFile&);
template Mesh<3> read_mesh_file<3>(const MeshFile&);

} // namespace kerf::fem
