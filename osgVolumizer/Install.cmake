# Installs both libraries, their headers with the folders they lie in, and the package that
# find_package(osgVolumizer CONFIG) reads. Two export sets, so that core can be had without OSG.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/osgVolumizer)
set(OSGVOLUMIZER_PLUGIN_DIR ${CMAKE_INSTALL_LIBDIR}/${OSGVOLUMIZER_PLUGIN_FOLDER})

install(TARGETS osgVolumizerCore EXPORT osgVolumizerCoreTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS osgVolumizer EXPORT osgVolumizerTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
# render/, io/ and folders named private/ are how it is done, not what is offered.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/osgVolumizer DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "render" EXCLUDE PATTERN "io" EXCLUDE
        PATTERN "private" EXCLUDE)

foreach(set osgVolumizerCoreTargets osgVolumizerTargets)
  install(EXPORT ${set} NAMESPACE osgVolumizer:: DESTINATION ${package_dir})
endforeach()
configure_package_config_file(osgVolumizerConfig.cmake.in
  ${PROJECT_BINARY_DIR}/osgVolumizerConfig.cmake INSTALL_DESTINATION ${package_dir}
  PATH_VARS OSGVOLUMIZER_PLUGIN_DIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/osgVolumizerConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES osgVolumizerDependencies.cmake ${PROJECT_BINARY_DIR}/osgVolumizerConfig.cmake
              ${PROJECT_BINARY_DIR}/osgVolumizerConfigVersion.cmake
        DESTINATION ${package_dir})
