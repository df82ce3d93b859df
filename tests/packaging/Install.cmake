# Installs BUILD into an empty PREFIX and checks that what a user needs has come along.
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX}
                RESULT_VARIABLE result OUTPUT_QUIET)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "The installation failed: ${result}")
endif()

# Every public header, in the folder that it has in the sources.
file(GLOB headers RELATIVE ${SOURCE} ${SOURCE}/osgVolumizer/*.h)
file(GLOB_RECURSE core_headers RELATIVE ${SOURCE} ${SOURCE}/osgVolumizer/core/*.h)
# Headers in folders named private/ stay behind.
list(FILTER core_headers EXCLUDE REGEX "/private/")
list(TRANSFORM headers PREPEND include/)
list(TRANSFORM core_headers PREPEND include/)
set(expected ${headers} ${core_headers}
  ${LIBRARIES}/libosgVolumizer.so ${LIBRARIES}/libosgVolumizerCore.so
  ${LIBRARIES}/cmake/osgVolumizer/osgVolumizerConfig.cmake
  ${LIBRARIES}/${PLUGINS}/osgdb_serializers_osgvolumizer.so ${LIBRARIES}/${PLUGINS}/osgdb_volume.so
  ${LIBRARIES}/pkgconfig/osgVolumizer.pc include/osgVolumizer/Version.h
  bin/osgvolumizerrender bin/osgvolumizertool
  share/doc/osgVolumizer/README.md share/doc/osgVolumizer/CHANGELOG.md share/doc/osgVolumizer/LICENSE)
# All data, since scenes name the files beside them.
file(GLOB data RELATIVE ${SOURCE}/data ${SOURCE}/data/*)
list(TRANSFORM data PREPEND share/osgVolumizer/)
list(APPEND expected ${data})
foreach(file ${expected})
  if(NOT EXISTS ${PREFIX}/${file})
    message(SEND_ERROR "Not installed: ${file}")
  endif()
endforeach()

foreach(folder private render io)
  file(GLOB_RECURSE found RELATIVE ${PREFIX} ${PREFIX}/include/*.h)
  list(FILTER found INCLUDE REGEX "/${folder}/")
  if(found)
    message(SEND_ERROR "Installed, but not public: ${found}")
  endif()
endforeach()

# Libraries find each other from wherever the prefix is put.
file(GLOB_RECURSE binaries ${PREFIX}/${LIBRARIES}/*.so ${PREFIX}/bin/*)
foreach(binary ${binaries})
  file(STRINGS ${binary} leaks REGEX "${BUILD}/lib" LIMIT_COUNT 1)
  if(leaks)
    message(SEND_ERROR "${binary} still refers to the build folder: ${leaks}")
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=LD_LIBRARY_PATH ldd ${binary}
                  OUTPUT_VARIABLE linked)
  if(linked MATCHES "(libosgVolumizer[^ ]*) => not found")
    message(SEND_ERROR "${binary} does not find ${CMAKE_MATCH_1}")
  endif()
endforeach()

# An exported target names no folder of the machine that it was built on.
file(GLOB package ${PREFIX}/${LIBRARIES}/cmake/osgVolumizer/*.cmake
     ${PREFIX}/${LIBRARIES}/pkgconfig/*.pc)
foreach(file ${package})
  file(READ ${file} text)
  string(FIND "${text}" "${SOURCE}" found)
  if(NOT found EQUAL -1 OR text MATCHES "[\";]/[^\";$]*\\.so")
    message(SEND_ERROR "${file} holds an absolute path of this machine")
  endif()
endforeach()
