// What is said of mesh files where there is no Gmsh library.
#include "fem_core/program/mesh_file.hpp"
#include "tests/unit/fem_mesh_checks.hpp"

#include <filesystem>
#include <fstream>

namespace kerf::fem {

TEST(MeshFileWithoutGmsh, is_refused_with_the_package_to_install) {
  const auto path = std::filesystem::temp_directory_path() / "kerf_without_gmsh.msh";
  std::ofstream(path) << "$MeshFormat";
  EXPECT_EQ(refusal([&] { read_mesh_file<2>({.path = path}); }),
            "mesh.file: " + path.string() +
                " is read with the Gmsh library, which this kerf is without (it was not built). "
                "Install the Debian package, apt-get install libgmsh-dev, then configure and build "
                "kerf again");
  std::filesystem::remove(path);
}

} // namespace kerf::fem
