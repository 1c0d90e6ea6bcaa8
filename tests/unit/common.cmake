# Tests of common/: case files, results, histories, surfaces.
add_executable(common_tests
  ${PROJECT_SOURCE_DIR}/tests/config/broken_cases.cpp
  ${PROJECT_SOURCE_DIR}/tests/config/broken_materials.cpp
  ${PROJECT_SOURCE_DIR}/tests/config/broken_meshes.cpp
  ${PROJECT_SOURCE_DIR}/tests/config/broken_elements.cpp
  ${PROJECT_SOURCE_DIR}/tests/config/broken_solids.cpp
  ${PROJECT_SOURCE_DIR}/tests/config/settings.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_checkpoint.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_facet_contact.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_history.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_log.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_nearest.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_packing_file.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_results.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/common_surface.cpp)
target_compile_definitions(
  common_tests PRIVATE KERF_REFERENCE_CASE="${PROJECT_SOURCE_DIR}/configs/reference.toml")
target_link_libraries(common_tests PRIVATE kerf::common kerf::warnings GTest::gtest_main)
gtest_discover_tests(common_tests)
