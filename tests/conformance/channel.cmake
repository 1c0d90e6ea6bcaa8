# channel_tests - transports, messages and the participant library, without solvers or a broker.
add_executable(channel_tests
  ${PROJECT_SOURCE_DIR}/tests/conformance/channel_suite.cpp
  ${PROJECT_SOURCE_DIR}/tests/conformance/echo_program.cpp
  ${PROJECT_SOURCE_DIR}/tests/conformance/shared_memory.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/protocol_bodies.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/protocol_frames.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/protocol_wire.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/participant_faults.cpp
  ${PROJECT_SOURCE_DIR}/tests/unit/participant_steps.cpp)
target_link_libraries(channel_tests PRIVATE kerf::participant cppzmq fmt::fmt
                                            nlohmann_json::nlohmann_json GTest::gtest_main
                                            Threads::Threads kerf::warnings)
target_compile_definitions(channel_tests PRIVATE KERF_ECHO_PROGRAM="$<TARGET_FILE:kerf_echo>")
add_dependencies(channel_tests kerf_echo)
gtest_discover_tests(channel_tests PROPERTIES TIMEOUT 300 LABELS "channel;conformance")
