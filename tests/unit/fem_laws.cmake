# Tests of the material laws at one point, and in the lanes of every set of instructions.
add_executable(fem_law_tests
  ${CMAKE_CURRENT_LIST_DIR}/fem_laws_input.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_laws_lanes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_laws_thermodynamics.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_laws_damage.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_laws_drucker_prager.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_laws_elastic.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_laws_neo_hookean.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_laws_plane_stress.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_laws_plastic.cpp)
target_link_libraries(fem_law_tests PRIVATE kerf::fem_laws Eigen3::Eigen kerf::warnings GTest::gtest_main)
kerf_add_kernels(fem_law_tests ${CMAKE_CURRENT_LIST_DIR}/fem_laws_kernel.cpp)
kerf_verification(fem_law_tests)
gtest_discover_tests(fem_law_tests PROPERTIES ${KERF_VERIFIES})
