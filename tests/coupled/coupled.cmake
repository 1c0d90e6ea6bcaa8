# Coupled runs: the physics in one process, then whole runs of the program.
add_executable(coupled_tests verification/coupled_chain.cpp)
target_link_libraries(coupled_tests PRIVATE kerf::broker kerf::dem kerf::fem kerf::warnings
                                            GTest::gtest_main)
gtest_discover_tests(coupled_tests)

add_executable(loopback_tests coupled/loopback.cpp)
target_link_libraries(loopback_tests PRIVATE kerf::commands kerf::dem_participant
                                             kerf::fem_participant kerf::warnings
                                             GTest::gtest_main)
target_compile_definitions(loopback_tests PRIVATE KERF_CONFIGS="${CMAKE_SOURCE_DIR}/configs"
                                                  KERF_PROGRAMS="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
gtest_discover_tests(loopback_tests)

# The cases are their own tests: they exit with 1 when an expectation is not met.
foreach(case wave_chain wave_bar wave_block)
  add_test(NAME case.${case}
           COMMAND kerf_program run ${CMAKE_SOURCE_DIR}/configs/${case}.toml --out
                   ${CMAKE_CURRENT_BINARY_DIR}/runs/${case})
endforeach()

kerf_python_test(coupled.bits coupled/bits.py Bits coupled)
kerf_python_test(fault.shm coupled/faults.py Fault fault)
kerf_python_test(fault.zmq coupled/faults.py FaultOverZeroMq fault)
kerf_python_test(fault.hang coupled/faults.py Hang fault)
set_tests_properties(fault.shm fault.zmq fault.hang PROPERTIES RUN_SERIAL ON)
