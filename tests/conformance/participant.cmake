# participant_tests - one suite for every participant program: each is started as a process, and a
# scripted broker plays the other side.
add_executable(participant_tests ${PROJECT_SOURCE_DIR}/tests/conformance/participant_suite.cpp)
target_link_libraries(participant_tests PRIVATE kerf::channel kerf::common fmt::fmt
                                                nlohmann_json::nlohmann_json GTest::gtest_main
                                                Threads::Threads kerf::warnings)
target_compile_definitions(participant_tests
                           PRIVATE KERF_PROGRAMS="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
add_dependencies(participant_tests kerf_echo kerf_dem_program kerf_fem_program)
gtest_discover_tests(participant_tests PROPERTIES TIMEOUT 60 LABELS conformance)
