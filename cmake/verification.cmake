# Tests that verify (tests/verification/verification.hpp) report to a folder; when all of them have
# run, the test verification.table compares docs/verification.md with it.
set(KERF_VERIFICATION_FOLDER ${CMAKE_BINARY_DIR}/verification)
# Properties of such a test, for gtest_discover_tests and set_tests_properties.
set(KERF_VERIFIES
    FIXTURES_REQUIRED verification LABELS verification
    ENVIRONMENT_MODIFICATION "KERF_VERIFICATION=set:${KERF_VERIFICATION_FOLDER}")

# kerf_verification(TARGET) - lets a program of GoogleTest verify.
function(kerf_verification target)
  add_dependencies(verification ${target})
  target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests/verification/verification.cpp)
  target_link_libraries(${target} PRIVATE nlohmann_json::nlohmann_json)
endfunction()

set(table ${KERF_PYTHON} ${PROJECT_SOURCE_DIR}/tests/verification/table.py)
add_test(NAME verification.table
         COMMAND ${table} --check ${KERF_VERIFICATION_FOLDER} ${CMAKE_BINARY_DIR})
set_tests_properties(verification.table PROPERTIES FIXTURES_CLEANUP verification
                                                   ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)
add_test(NAME verification.rules
         COMMAND ${KERF_PYTHON} ${PROJECT_SOURCE_DIR}/tests/verification/table_rules.py -v)
set_tests_properties(verification.rules PROPERTIES ENVIRONMENT PYTHONDONTWRITEBYTECODE=1)

# Runs all of them and writes the page anew.
add_custom_target(verification
  COMMAND ${CMAKE_CTEST_COMMAND} -L "^verification$" -FC verification -j 2 --output-on-failure
  COMMAND ${table} --write ${KERF_VERIFICATION_FOLDER} ${CMAKE_BINARY_DIR}
  USES_TERMINAL VERBATIM)
add_dependencies(verification kerf_program kerf_dem_program kerf_fem_program)
