# What the libraries are linked with in public. Read by our own build and, once installed, by
# osgVolumizerConfig.cmake, so that both mean the same by osgVolumizer::OpenSceneGraph: CMake's
# FindOpenSceneGraph gives variables with absolute paths, which must not be written into an
# exported target.
macro(osgvolumizer_find_openscenegraph)
  find_package(OpenSceneGraph 3.6 ${ARGN} COMPONENTS osgDB osgGA osgManipulator osgUtil osgViewer osgText osgSim)
  if(OPENSCENEGRAPH_FOUND AND NOT TARGET osgVolumizer::OpenSceneGraph)
    add_library(osgVolumizer::OpenSceneGraph INTERFACE IMPORTED)
    set_target_properties(osgVolumizer::OpenSceneGraph PROPERTIES
      INTERFACE_INCLUDE_DIRECTORIES "${OPENSCENEGRAPH_INCLUDE_DIRS}")
    target_link_libraries(osgVolumizer::OpenSceneGraph INTERFACE ${OPENSCENEGRAPH_LIBRARIES})
  endif()
endmacro()
