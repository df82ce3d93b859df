# Every C++ file is as .clang-format says.
file(GLOB_RECURSE files ${SOURCE}/osgVolumizer/*.h ${SOURCE}/osgVolumizer/*.cpp
     ${SOURCE}/plugins/*.h ${SOURCE}/plugins/*.cpp ${SOURCE}/examples/*.h ${SOURCE}/examples/*.cpp
     ${SOURCE}/tests/*.h ${SOURCE}/tests/*.cpp)
if(NOT files)
  message(FATAL_ERROR "No C++ files under ${SOURCE}")
endif()
execute_process(COMMAND ${CLANG_FORMAT} --dry-run --Werror ${files}
                RESULT_VARIABLE result ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  string(REGEX MATCHALL "[^\n]*code should be clang-formatted" places "${output}")
  list(TRANSFORM places REPLACE ":[0-9]+:[0-9]+: .*" "")
  list(REMOVE_DUPLICATES places)
  list(JOIN places "\n" places)
  message(FATAL_ERROR "To be formatted with ${CLANG_FORMAT} -i:\n${places}")
endif()
