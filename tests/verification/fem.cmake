# The finite element engine against closed forms and published numbers.
add_executable(fem_verification_tests
  ${CMAKE_CURRENT_LIST_DIR}/fem_absorbing.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_beams.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_elasticity.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_excavation.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_hourglass.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_manufactured.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_objective_rate.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_standing_waves.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_static.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_taylor_bar.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_wave_speeds.cpp)
target_link_libraries(fem_verification_tests PRIVATE kerf::fem kerf::warnings GTest::gtest_main)
kerf_verification(fem_verification_tests)
gtest_discover_tests(fem_verification_tests TEST_PREFIX fem_verification.
  PROPERTIES ENVIRONMENT OMP_WAIT_POLICY=passive ${KERF_VERIFIES})
kerf_python_test(verification.excavation verification/fem_excavation.py Excavation verification)
