# Coupled runs: the physics in one process, then whole runs of the program.
add_executable(coupled_tests verification/coupled_chain.cpp)
target_link_libraries(coupled_tests PRIVATE kerf::broker kerf::dem kerf::fem kerf::warnings
                                            fmt::fmt GTest::gtest_main)
kerf_verification(coupled_tests)
gtest_discover_tests(coupled_tests PROPERTIES ENVIRONMENT OMP_WAIT_POLICY=passive ${KERF_VERIFIES})

add_executable(loopback_tests coupled/loopback.cpp)
target_link_libraries(loopback_tests PRIVATE kerf::commands kerf::dem_participant
                                             kerf::fem_participant kerf::warnings
                                             GTest::gtest_main)
target_compile_definitions(loopback_tests PRIVATE KERF_CONFIGS="${CMAKE_SOURCE_DIR}/configs"
                                                  KERF_PROGRAMS="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
gtest_discover_tests(loopback_tests)

# The cases are their own tests: they exit with 1 when an expectation is not met.
function(kerf_case name case) # and settings
  add_test(NAME case.${name}
           COMMAND ${KERF_PYTHON} ${CMAKE_SOURCE_DIR}/tests/cases/expectations.py
                   ${CMAKE_SOURCE_DIR}/configs/${case}.toml
                   ${CMAKE_CURRENT_BINARY_DIR}/runs/${name} ${ARGN})
  set_tests_properties(
    case.${name} PROPERTIES ${KERF_VERIFIES} ENVIRONMENT
    "KERF_PROGRAMS=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};KERF_TEST=case.${name};PYTHONDONTWRITEBYTECODE=1")
endfunction()
foreach(case wave_chain wave_bar wave_block)
  kerf_case(${case} ${case})
endforeach()

# Variants of the chain: what they may reflect, from an independent study of chains (see
# docs/theory/coupling.md).
function(kerf_chain_variant name least most)
  kerf_case(wave_chain.${name} wave_chain measures.reflected_energy.expect.min=${least}
            measures.reflected_energy.expect.max=${most} ${ARGN})
endfunction()
set(penalty couplings.joint.method=penalty measures.constraint_violation.expect.max=1e-6)
kerf_chain_variant(elements_of_two_spacings 0 5e-4 "participants.bar.mesh.count=[60, 1]"
                   couplings.joint.width=8e-3 "participants.chain.particles.lattice.count=[108, 1]")
kerf_chain_variant(elements_of_four_spacings 0 5e-3 "participants.bar.mesh.count=[30, 1]"
                   couplings.joint.width=16e-3 "participants.chain.particles.lattice.count=[116, 1]")
kerf_chain_variant(penalty_1 0 1.5e-3 ${penalty})
kerf_chain_variant(penalty_3 0 2e-4 ${penalty} couplings.joint.stiffness_ratio=3.0)
kerf_chain_variant(without_blending 0.16 0.18 couplings.joint.blending=false)

kerf_python_test(coupled.bits coupled/bits.py Bits coupled)
kerf_python_test(fault.shm coupled/faults.py Fault fault)
kerf_python_test(fault.zmq coupled/faults.py FaultOverZeroMq fault)
kerf_python_test(fault.hang coupled/faults.py Hang fault)
set_tests_properties(fault.shm fault.zmq fault.hang PROPERTIES RUN_SERIAL ON)
kerf_python_test(coupled.packings coupled/packings.py Packings config)
