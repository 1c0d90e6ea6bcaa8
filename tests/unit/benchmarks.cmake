# Tests of the models that kerf bench times, and of its command line.
add_executable(benchmark_tests
  ${CMAKE_CURRENT_LIST_DIR}/benchmarks.cpp
  ${CMAKE_SOURCE_DIR}/tests/benchmarks/fem_models.cpp
  ${CMAKE_SOURCE_DIR}/tests/benchmarks/options.cpp)
target_link_libraries(benchmark_tests PRIVATE kerf::fem CLI11::CLI11 nlohmann_json::nlohmann_json
  OpenMP::OpenMP_CXX fmt::fmt kerf::warnings GTest::gtest_main)
gtest_discover_tests(benchmark_tests PROPERTIES ENVIRONMENT OMP_WAIT_POLICY=passive)
