# Looks for OpenVDB: OSGVOLUMIZER_OPENVDB_WORKS where there is one, and osgVolumizerOpenVdb to link. It
# brings a module for CMake, FindOpenVDB, which cannot be asked quietly, and wants what a program that
# links the shared library does not need.
include_guard(GLOBAL)
include(CheckCXXSourceCompiles)
find_path(OSGVOLUMIZER_OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OSGVOLUMIZER_OPENVDB_LIBRARY openvdb)
find_library(OSGVOLUMIZER_TBB_LIBRARY tbb)
find_library(OSGVOLUMIZER_IMATH_LIBRARY NAMES Imath Imath-3_1 Half) # its table of halves
find_path(OSGVOLUMIZER_IMATH_INCLUDE_DIR half.h PATH_SUFFIXES Imath OpenEXR)
mark_as_advanced(OSGVOLUMIZER_OPENVDB_INCLUDE_DIR OSGVOLUMIZER_OPENVDB_LIBRARY
                 OSGVOLUMIZER_TBB_LIBRARY OSGVOLUMIZER_IMATH_LIBRARY
                 OSGVOLUMIZER_IMATH_INCLUDE_DIR)
if(OSGVOLUMIZER_OPENVDB_INCLUDE_DIR AND OSGVOLUMIZER_OPENVDB_LIBRARY AND OSGVOLUMIZER_TBB_LIBRARY)
  set(includes ${OSGVOLUMIZER_OPENVDB_INCLUDE_DIR})
  if(OSGVOLUMIZER_IMATH_INCLUDE_DIR)
    list(APPEND includes ${OSGVOLUMIZER_IMATH_INCLUDE_DIR})
  endif()
  set(libraries ${OSGVOLUMIZER_OPENVDB_LIBRARY} ${OSGVOLUMIZER_TBB_LIBRARY})
  if(OSGVOLUMIZER_IMATH_LIBRARY)
    list(APPEND libraries ${OSGVOLUMIZER_IMATH_LIBRARY})
  endif()
  # How plugin, tests and chart use it.
  add_library(osgVolumizerOpenVdb INTERFACE)
  target_include_directories(osgVolumizerOpenVdb SYSTEM INTERFACE ${includes})
  target_link_libraries(osgVolumizerOpenVdb INTERFACE ${libraries})
  set(CMAKE_REQUIRED_INCLUDES ${includes})
  set(CMAKE_REQUIRED_LIBRARIES ${libraries})
  check_cxx_source_compiles("#include <openvdb/openvdb.h>
    int main() { openvdb::initialize(); return openvdb::FloatGrid().empty() ? 0 : 1; }"
    OSGVOLUMIZER_OPENVDB_WORKS)
  unset(CMAKE_REQUIRED_INCLUDES)
  unset(CMAKE_REQUIRED_LIBRARIES)
endif()
if(NOT OSGVOLUMIZER_OPENVDB_WORKS)
  unset(OSGVOLUMIZER_OPENVDB_WORKS CACHE) # what is missing may come
endif()
