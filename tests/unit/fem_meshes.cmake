# Tests of finite element meshes; those of mesh files need the Gmsh library.
add_executable(fem_mesh_tests
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_box.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_quality.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_round.cpp)
target_link_libraries(fem_mesh_tests PRIVATE kerf::fem_mesh kerf::fem_mesh_file fmt::fmt
  kerf::warnings GTest::gtest_main)
if(TARGET gmsh::gmsh)
  target_sources(fem_mesh_tests PRIVATE ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_file.cpp)
  target_link_libraries(fem_mesh_tests PRIVATE gmsh::gmsh)
else()
  target_sources(fem_mesh_tests PRIVATE ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_no_file.cpp)
endif()
gtest_discover_tests(fem_mesh_tests)
