# Configures, builds and runs the project in SOURCE against the installation in PREFIX. With
# WITHOUT_OSG, no header and no library of OSG or GL may be in what was built.
include(${CMAKE_CURRENT_LIST_DIR}/Run.cmake)

set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
endif()
file(REMOVE_RECURSE ${BINARY})
file(MAKE_DIRECTORY ${BINARY})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G Ninja -DCMAKE_PREFIX_PATH=${PREFIX}
    -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${flags}" "-DREADME=${README}")
run(${CMAKE_COMMAND} --build ${BINARY})
set(environment ${CMAKE_COMMAND} -E env --unset=LD_LIBRARY_PATH --unset=OSG_LIBRARY_PATH)
run(${environment} ${BINARY}/consumer)
if(EXISTS ${BINARY}/reader)
  run(${environment} ${BINARY}/reader)
endif()

# The program of the README: without a file that it finds it says so; on a virtual display it draws.
if(README)
  execute_process(COMMAND ${environment} ${BINARY}/readme nothing.tif WORKING_DIRECTORY ${BINARY}
                  RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors)
  if(NOT result EQUAL 1 OR NOT errors MATCHES "^[^\n]*nothing.tif[^\n]*\n$")
    message(FATAL_ERROR "The README's program, without a volume: ${result}\n${errors}")
  endif()
  get_filename_component(root ${README} DIRECTORY)
  find_program(XVFB_RUN xvfb-run)
  if(XVFB_RUN)
    run(${environment} OSG_RUN_FRAME_COUNT=2 "OSG_WINDOW=0 0 200 150" LIBGL_ALWAYS_SOFTWARE=1
        ASAN_OPTIONS=detect_leaks=0 ${XVFB_RUN} -a ${BINARY}/readme ${root}/data/head.tif)
  endif()
endif()

if(WITHOUT_OSG)
  run(ninja -C ${BINARY} -t deps)
  if(NOT output MATCHES "core/geometry/TetraSet.h")
    message(FATAL_ERROR "The list of headers is not what it was thought to be:\n${output}")
  endif()
  if(output MATCHES "[^\n]*/(osg[A-Za-z]*|OpenThreads|GL|EGL)/[A-Z][A-Za-z]*(\\.h)?\n" AND
     NOT CMAKE_MATCH_0 MATCHES "osgVolumizer/core")
    message(FATAL_ERROR "core includes ${CMAKE_MATCH_0}")
  endif()
  run(ldd ${BINARY}/consumer)
  if(output MATCHES "lib(osg[A-Z]?[a-uw-z]*|GL|EGL|OpenGL)\\.so[^\n]*")
    message(FATAL_ERROR "core is linked with ${CMAKE_MATCH_0}")
  endif()
endif()
