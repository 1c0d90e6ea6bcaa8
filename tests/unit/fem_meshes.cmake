# Tests of finite element meshes; those of mesh files need the Gmsh library.
add_executable(fem_mesh_tests
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_box.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_quality.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_round.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_settings.cpp)
target_link_libraries(fem_mesh_tests PRIVATE kerf::fem_mesh kerf::fem_mesh_settings fmt::fmt
  nlohmann_json::nlohmann_json kerf::warnings GTest::gtest_main)
gtest_discover_tests(fem_mesh_tests)

if(TARGET gmsh::gmsh)
  add_executable(fem_mesh_file_tests
    ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_bad_file.cpp
    ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_file.cpp)
  target_link_libraries(fem_mesh_file_tests PRIVATE kerf::fem_mesh_file kerf::fem_mesh_settings
    gmsh::gmsh fmt::fmt nlohmann_json::nlohmann_json OpenMP::OpenMP_CXX kerf::warnings
    GTest::gtest_main)
  # What Gmsh and OpenCASCADE leave behind is theirs.
  gtest_discover_tests(fem_mesh_file_tests PROPERTIES ENVIRONMENT
    "LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_LIST_DIR}/gmsh_leaks.txt")
endif()

# A program without the library beside it says what to install.
add_executable(fem_mesh_no_file_tests ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_no_file.cpp)
set_target_properties(fem_mesh_no_file_tests PROPERTIES
  RUNTIME_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/without_gmsh)
target_link_libraries(fem_mesh_no_file_tests PRIVATE kerf::fem_mesh_file fmt::fmt kerf::warnings
  GTest::gtest_main)
gtest_discover_tests(fem_mesh_no_file_tests)
