# Where GoogleTest is missing the build is configured without tests, and says so; asked for tests, it
# refuses, and names the package. Where it is found, nobody has to ask for tests.
function(configure)
  file(REMOVE_RECURSE ${BINARY})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER}
            -DOSGVOLUMIZER_BUILD_PLUGINS=OFF ${ARGN}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  set(result ${result} PARENT_SCOPE)
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(without -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
configure(${without})
if(NOT result EQUAL 0 OR NOT output MATCHES "libgtest-dev" OR EXISTS ${BINARY}/tests)
  message(SEND_ERROR "Without GoogleTest: ${result}\n${output}")
endif()

configure(${without} -DOSGVOLUMIZER_BUILD_TESTS=ON)
if(result EQUAL 0 OR NOT output MATCHES "CMake Error[^\n]*\n[^\n]*OSGVOLUMIZER_BUILD_TESTS is ON" OR
   NOT output MATCHES "libgtest-dev")
  message(SEND_ERROR "Asked for tests, without GoogleTest: ${result}\n${output}")
endif()

configure()
if(NOT result EQUAL 0 OR NOT EXISTS ${BINARY}/tests)
  message(SEND_ERROR "With GoogleTest: ${result}\n${output}")
endif()
