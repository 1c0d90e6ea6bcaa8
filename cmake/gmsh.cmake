# The Gmsh library, which reads and makes meshes for kerf-fem (Debian: libgmsh-dev). It is under the
# GPL: README.md says what that means. KERF_GMSH: AUTO takes it when it is there, ON demands it.
set(KERF_GMSH AUTO CACHE STRING "Read mesh files with the Gmsh library: AUTO, ON or OFF")
set_property(CACHE KERF_GMSH PROPERTY STRINGS AUTO ON OFF)
if(KERF_GMSH)
  find_path(GMSH_INCLUDE_DIR gmsh.h)
  find_library(GMSH_LIBRARY gmsh)
  if(GMSH_INCLUDE_DIR AND GMSH_LIBRARY)
    add_library(gmsh::gmsh UNKNOWN IMPORTED)
    set_target_properties(gmsh::gmsh PROPERTIES IMPORTED_LOCATION "${GMSH_LIBRARY}"
                                                INTERFACE_INCLUDE_DIRECTORIES "${GMSH_INCLUDE_DIR}")
  elseif(NOT KERF_GMSH STREQUAL AUTO)
    message(FATAL_ERROR "KERF_GMSH is ON, but there is no Gmsh library: apt-get install libgmsh-dev")
  endif()
endif()
