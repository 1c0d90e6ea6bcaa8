// What is said of mesh files where kerf was built without the Gmsh library.
#include "fem_core/program/mesh_file.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

namespace kerf::fem {

TEST(MeshFileWithoutGmsh, is_refused_with_the_package_to_install) {
  EXPECT_EQ(
      refusal([] { read_mesh_file<2>({.path = "rock.msh"}); }),
      "mesh.file: rock.msh is read with the Gmsh library, which this kerf was built without. "
      "Install its Debian package, apt-get install libgmsh-dev, then configure and build kerf "
      "again with -DKERF_GMSH=ON");
}

} // namespace kerf::fem
