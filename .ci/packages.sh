# Sourced by tests/run.sh, tests/bench/charting.sh and examples/demo.sh: the Debian packages that each
# needs, and install_missing PACKAGE..., which installs those that are not there, and calls apt-get
# only if there are any.

# What the libraries, plugins and tools are built with; README names the same (a test compares them).
#   openimageio-tools         Debian's CMake files of OpenImageIO refuse to be read where its programs
#                             are missing, though nothing here calls them
#   libegl-dev libopengl-dev  the render tool draws without a window; what it is linked with
#   libegl-mesa0              EGL's driver, without which libegl-dev finds no device
BUILD_PACKAGES="g++ cmake ninja-build libopenscenegraph-dev libglm-dev libopenimageio-dev openimageio-tools libegl-dev libopengl-dev libegl-mesa0"
# What tests/run.sh needs on top.
#   openscenegraph xvfb xauth             stock osgviewer on a virtual display
#   clang-14 libclang-rt-14-dev           the fuzz targets
#   pkg-config                            a program linked with what the .pc file says
TEST_PACKAGES="libgtest-dev libgl1-mesa-dri openscenegraph xvfb xauth clang-14 libclang-rt-14-dev clang-format-14 git pkg-config"
# What examples/demo.sh needs on top, and what else where there is no display.
DEMO_PACKAGES="openscenegraph libgl1-mesa-dri"
HEADLESS_DEMO_PACKAGES="xvfb imagemagick"
# What the charts (tests/bench/charting.sh) need on top: GoogleTest, since benchmarks are among the
# tests, the peers in OpenSceneGraph, and a display for VTK.
CHART_PACKAGES="libgtest-dev libgl1-mesa-dri openscenegraph xvfb xauth python3"
# A peer in the chart of volumes; it goes without.
CHART_VOLPACK_PACKAGES="libvolpack1-dev"
# Readers of .vtk and .vtu files, and peers in the charts; all goes without it.
VTK_PACKAGES="libvtk9-dev"
# The reader of TIFF with depth, and of other rare ones; all goes without it.
TIFF_PACKAGES="libtiff-dev"
# The reader of HDF5 files; all goes without it.
HDF5_PACKAGES="libhdf5-dev"
# The reader of DICOM, NIfTI, NRRD, ..., with GDCM among what it depends on; all goes without it.
ITK_PACKAGES="libinsighttoolkit5-dev"
# Whose test files its tests read: nothing of Python itself is called.
ITK_TEST_PACKAGES="python3-pydicom python3-nibabel"
# The reader of NetCDF and Zarr; all goes without it.
GDAL_PACKAGES="libgdal-dev"
# The reader of OpenVDB grids, and a peer in the chart of volumes; all goes without it.
#   libboost-dev    OpenVDB's headers include some of it, and its package does not say so
OPENVDB_PACKAGES="libopenvdb-dev libboost-dev"

install_missing() {
    command -v dpkg-query >/dev/null || {
        echo "This is no Debian system. Needed, under whatever name: $*" >&2
        return 0
    }
    local missing=() package root=()
    for package in "$@"; do
        dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
            missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    echo "Installing ${missing[*]}"
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "Not root, and no sudo. Please install: ${missing[*]}" >&2
            return 1
        }
        root=(sudo)
    fi
    "${root[@]}" apt-get update -qq &&
        "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
            apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}
