# Runs that go on from a checkpoint.
kerf_python_test(restart.bits restart/restart.py Restart restart verification)
kerf_python_test(restart.killed restart/restart.py Killed restart fault)
kerf_python_test(restart.refused restart/restart.py Refused restart)
kerf_python_test(restart.extended restart/restart.py Extended restart)
set_tests_properties(restart.killed PROPERTIES RUN_SERIAL ON)
kerf_python_test(stages.stop restart/stages.py Stop stages)
kerf_python_test(stages.stages restart/stages.py Stages stages)
