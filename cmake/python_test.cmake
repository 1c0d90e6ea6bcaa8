# kerf_python_test(NAME FILE CASE LABELS…) - one unittest class of a script that starts kerf. It also
# has the label process. With the label verification it verifies.
function(kerf_python_test name file class)
  add_test(NAME ${name} COMMAND ${KERF_PYTHON} ${CMAKE_SOURCE_DIR}/tests/${file} -v ${class})
  if(verification IN_LIST ARGN)
    set_tests_properties(${name} PROPERTIES ${KERF_VERIFIES})
  endif()
  set_tests_properties(
    ${name} PROPERTIES LABELS "process;${ARGN}" ENVIRONMENT
                       "KERF_PROGRAMS=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};KERF_TEST=${name};PYTHONDONTWRITEBYTECODE=1"
                       TIMEOUT 600)
endfunction()
