# Installs both libraries, their headers with the folders they lie in, and what finds them:
# find_package(osgVolumizer CONFIG), with two export sets, so that core can be had without OSG, and
# pkg-config. Documents and data come along.
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
install(DIRECTORY ${generated_headers}/osgVolumizer DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

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

# Relative to where the file lies, so that the prefix can be moved.
set(pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH PREFIX_FROM_PC /prefix/${pc_dir} /prefix)
configure_file(osgVolumizer.pc.in ${PROJECT_BINARY_DIR}/osgVolumizer.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/osgVolumizer.pc DESTINATION ${pc_dir})

install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
              ${PROJECT_SOURCE_DIR}/LICENSE
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/osgVolumizer)
