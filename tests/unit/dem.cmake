# dem_tests - the particle engine: its parts, its mathematics, its settings.
add_executable(dem_tests
  ${CMAKE_CURRENT_LIST_DIR}/dem_boundary.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_change.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_contact.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_cracks.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_damping.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_engine.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_lattice.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_materials.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_materials_read.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_neighbours.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_order.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_packing.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_settings.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_state.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_tool.cpp
  ${CMAKE_CURRENT_LIST_DIR}/dem_wall_contacts.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_beam.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_clusters.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_contact_laws.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_critical_step.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_energy.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_impact.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_in_situ_stress.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_lattice_moduli.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_loads.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_mass_scaling.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_materials.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_momentum.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_oscillation.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_packing_moduli.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_stress.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_walls.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../verification/dem_waves.cpp)
target_link_libraries(dem_tests PRIVATE kerf::dem kerf::dem_participant kerf::warnings fmt::fmt
                                        OpenMP::OpenMP_CXX GTest::gtest_main)
# Threads that spin between two tiny loops cost more than the loops.
kerf_verification(dem_tests)
gtest_discover_tests(dem_tests PROPERTIES ENVIRONMENT OMP_WAIT_POLICY=passive ${KERF_VERIFIES})

kerf_python_test(case.tools verification/tools.py Tools)
kerf_python_test(case.boundaries verification/bodies.py Boundaries)
kerf_python_test(case.clusters verification/bodies.py Clusters)
kerf_python_test(case.materials verification/bodies.py Materials)
kerf_python_test(case.mass_scaling verification/bodies.py MassScaling)
kerf_python_test(case.in_situ_stress verification/bodies.py InSituStress verification)
kerf_python_test(case.grains verification/bodies.py Grains)
