# run(COMMAND...) runs a command in BINARY, behind RUN_ENVIRONMENT if that is set, and ends the test with
# what it said where it fails; else what it said is in `output`.
function(run)
  execute_process(COMMAND ${RUN_ENVIRONMENT} ${ARGN} WORKING_DIRECTORY ${BINARY}
                  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${result}\n${output}${errors}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()
