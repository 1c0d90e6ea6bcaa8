# kerf against YADE and FEniCSx.
kerf_python_test(reference.yade reference/wave.py
                 Wave.test_a_wave_in_a_bonded_lattice_is_that_of_yade reference verification)
kerf_python_test(reference.fenicsx reference/wave.py
                 Wave.test_a_pulse_in_a_bar_of_quadrilaterals_is_that_of_fenicsx reference
                 verification)
kerf_python_test(reference.yade_motion reference/block.py
                 Block.test_until_a_bond_breaks_the_motion_is_that_of_yade reference verification)
kerf_python_test(reference.yade_breakage reference/block.py
                 Block.test_the_block_breaks_like_that_of_yade reference verification)
kerf_python_test(reference.yade_pair reference/pair.py Pair reference verification)
kerf_python_test(reference.yade_column reference/grains.py Grains.test_a_column_that_settles
                 reference verification)
kerf_python_test(reference.yade_tool reference/grains.py
                 Grains.test_a_plate_that_is_dragged_through_a_bed reference verification)

add_executable(fem_run ${CMAKE_CURRENT_LIST_DIR}/fem_run.cpp)
target_link_libraries(fem_run PRIVATE kerf::fem nlohmann_json::nlohmann_json kerf::warnings)
add_dependencies(verification fem_run)
foreach(shape triangles quadrilaterals tetrahedra hexahedra)
  kerf_python_test(reference.fenicsx_${shape} reference/elements.py
                   Elements.test_${shape}_move_as_in_fenicsx reference verification)
endforeach()
