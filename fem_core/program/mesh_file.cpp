#include "fem_core/program/mesh_file.hpp"

#include "fem_core/input_error.hpp"
#include "fem_core/program/gmsh_reader.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>

namespace kerf::fem {
namespace {

/// The library stands beside the program, as it is built, or in lib/kerf, as it is installed. It
/// stays loaded.
void* load_library(const MeshFile& file) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::string reason = "it was not built";
  for (const char* name : {"kerf_gmsh.so", "../lib/kerf/kerf_gmsh.so"})
    if (const auto path = program / name; std::filesystem::exists(path)) {
      if (void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
        return library;
      reason = dlerror();
    }
  throw InputError("mesh.file",
                   fmt::format("{} is read with the Gmsh library, which this kerf is without ({}). "
                               "Install the Debian package, apt-get install libgmsh-dev, then "
                               "configure and build kerf again",
                               file.path.string(), reason));
}

} // namespace

template <int dim> Mesh<dim> read_mesh_file(const MeshFile& file) {
  const std::string kind = file.path.extension().string();
  const bool is_step = kind == ".step" || kind == ".stp", is_geometry = is_step || kind == ".geo";
  if (!is_geometry && kind != ".msh")
    throw InputError("mesh.file", file.path.string() + " must be a .msh, .geo, .step or .stp file");
  if (!(file.scale > 0.0 && std::isfinite(file.scale)))
    throw InputError("mesh.scale", fmt::format("the scale is {}; it must be positive", file.scale));
  if (file.element_size && !(is_geometry && *file.element_size > 0.0))
    throw InputError("mesh.element_size",
                     is_geometry
                         ? fmt::format("it is {} m; it must be positive", *file.element_size)
                         : file.path.string() + " is a mesh, whose elements have a size; "
                                                "leave it out");
  if (is_step && !file.element_size)
    throw InputError("mesh.element_size",
                     file.path.string() + " is a geometry; give the largest size of its elements");

  if (!std::filesystem::is_regular_file(file.path))
    throw InputError("mesh.file", "there is no file " + file.path.string());

  if (std::string first; is_step && !(std::ifstream(file.path) >> first &&
                                      first.starts_with("ISO-10303-21"))) // else OpenCASCADE prints
    throw InputError("mesh.file", file.path.string() +
                                      " is not a STEP file: it does not begin with ISO-10303-21");

  const char* name = dim == 2 ? "kerf_gmsh_read_2" : "kerf_gmsh_read_3";
  using Read = void(const MeshFile&, bool, Mesh<dim>&);
  const auto read = reinterpret_cast<Read*>(dlsym(load_library(file), name));
  Mesh<dim> mesh;
  read(file, is_geometry, mesh);
  return mesh;
}

template Mesh<2> read_mesh_file<2>(const MeshFile&);
template Mesh<3> read_mesh_file<3>(const MeshFile&);

} // namespace kerf::fem
