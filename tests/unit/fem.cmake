# Tests of the finite element engine and of its participant.
add_executable(fem_tests
  ${CMAKE_CURRENT_LIST_DIR}/fem_change.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_elements.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_engine.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_loads.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_participant.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_restart.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_settings.cpp
  ${CMAKE_CURRENT_LIST_DIR}/fem_step_limit.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/fem_waves.cpp)
target_link_libraries(fem_tests PRIVATE kerf::fem kerf::fem_participant kerf::channel kerf::common
  nlohmann_json::nlohmann_json OpenMP::OpenMP_CXX kerf::warnings GTest::gtest_main)
kerf_verification(fem_tests)
gtest_discover_tests(fem_tests PROPERTIES ENVIRONMENT OMP_WAIT_POLICY=passive ${KERF_VERIFIES})
