# Each header in PREFIX compiles by itself, and without a warning in a program that is strict with its
# own code and takes the headers for that: they are not in a system folder there.
file(GLOB_RECURSE headers RELATIVE ${PREFIX}/include ${PREFIX}/include/osgVolumizer/*.h)
list(LENGTH headers count)
if(count LESS 40)
  message(FATAL_ERROR "Only ${count} headers are installed in ${PREFIX}")
endif()
file(MAKE_DIRECTORY ${BINARY})
foreach(header ${headers})
  file(WRITE ${BINARY}/header.cpp "#include <${header}>\n")
  execute_process(
    COMMAND ${COMPILER} -std=c++17 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
            -I ${PREFIX}/include ${BINARY}/header.cpp
    RESULT_VARIABLE result ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(SEND_ERROR "${header}:\n${output}")
  endif()
endforeach()
