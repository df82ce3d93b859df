# The tools in PREFIX run from there, and find libraries and plugins without being told of a folder.
include(${CMAKE_CURRENT_LIST_DIR}/Run.cmake)
set(RUN_ENVIRONMENT ${CMAKE_COMMAND} -E env --unset=LD_LIBRARY_PATH --unset=OSG_LIBRARY_PATH
    --unset=OSG_FILE_PATH)

file(REMOVE_RECURSE ${BINARY})
file(MAKE_DIRECTORY ${BINARY})
foreach(tool osgvolumizerrender osgvolumizertool)
  run(${PREFIX}/bin/${tool} --version)
  if(NOT output STREQUAL "${tool} ${VERSION}\n")
    message(SEND_ERROR "${tool} --version says: ${output}")
  endif()
endforeach()

# The scene, the scan that it names, and a volume without a scene, all as installed. There is nothing
# but a volume in them, so that the picture shows one where it shows anything.
find_program(IINFO iinfo REQUIRED)
foreach(scene head.osgt head.tif.volume)
  run(${PREFIX}/bin/osgvolumizerrender ${PREFIX}/share/osgVolumizer/${scene} --size 64 64
      --output ${scene}.exr)
  run(${IINFO} --stats ${scene}.exr)
  if(NOT output MATCHES "Stats Max: [0-9.]+ [0-9.]+ [0-9.]+ ([0-9.]+)" OR CMAKE_MATCH_1 LESS 0.5)
    message(SEND_ERROR "There is no volume in the picture of ${scene}:\n${output}")
  endif()
endforeach()
