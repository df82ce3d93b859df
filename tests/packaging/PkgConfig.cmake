# Programs are compiled by hand against PREFIX, with what its pkg-config file says and no more.
include(${CMAKE_CURRENT_LIST_DIR}/Run.cmake)
set(RUN_ENVIRONMENT ${CMAKE_COMMAND} -E env --unset=OSG_LIBRARY_PATH
    PKG_CONFIG_PATH=${PREFIX}/${LIBRARIES}/pkgconfig LD_LIBRARY_PATH=${PREFIX}/${LIBRARIES})

file(REMOVE_RECURSE ${BINARY})
file(MAKE_DIRECTORY ${BINARY})
run(${PKG_CONFIG} --modversion osgVolumizer)
string(STRIP "${output}" output)
if(NOT output STREQUAL VERSION)
  message(SEND_ERROR "Version ${output}, expected ${VERSION}")
endif()
run(${PKG_CONFIG} --cflags --libs osgVolumizer)
string(STRIP "${output}" output)
separate_arguments(flags UNIX_COMMAND "${output}")
if(SANITIZE)
  list(APPEND flags -fsanitize=${SANITIZE})
endif()

# A program that uses the library, one that only reads scenes with it, and the README's.
file(READ ${SOURCE}/README.md readme)
string(REGEX MATCH "```cpp\n([^`]*)```" found "${readme}")
file(WRITE ${BINARY}/readme.cpp "${CMAKE_MATCH_1}")
set(consumer ${SOURCE}/tests/packaging/consumer)
run(${COMPILER} -std=c++17 ${consumer}/main.cpp -o main ${flags})
run(${COMPILER} -std=c++17 ${consumer}/reader.cpp -o reader ${flags})
run(${COMPILER} -std=c++17 readme.cpp -o readme ${flags})
run(${BINARY}/main)
run(${BINARY}/reader)
