# Tests of finite element meshes.
add_executable(fem_mesh_tests
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_box.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_quality.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_mesh_round.cpp)
target_link_libraries(fem_mesh_tests PRIVATE kerf::fem_mesh fmt::fmt kerf::warnings
  GTest::gtest_main)
gtest_discover_tests(fem_mesh_tests)
