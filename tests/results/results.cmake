# Whole runs whose files are read as a user would.
kerf_python_test(results.rock results/rock.py Rock results)
kerf_python_test(results.lost_particles results/rock.py LostParticles results)
kerf_python_test(results.million results/large.py Million results long)
set_tests_properties(results.million PROPERTIES TIMEOUT 1800 RUN_SERIAL ON)
