#!/usr/bin/env bash
# Draws the pictures of README.md, but for the chart (tests/bench/chart.sh), into .pictures, and records
# there what they were made from. Builds what it needs; takes some minutes on a software rasteriser.
#
#   bash examples/pictures.sh            draws them
#   bash examples/pictures.sh --check    fails where shaders or scenes have changed since
set -eu -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
state=.pictures/STATE

# What pictures are made from: the code of shaders, scenes with what they refer to, and this script.
inputs() {
    find osgVolumizer/render -name '*.glsl' | LC_ALL=C sort
    echo data/head.tif data/head.lut data/head.osgt data/mixed.osgt data/activation.tif \
        examples/pictures.sh | tr ' ' '\n'
}
made_from() { inputs | xargs cat | sha256sum | cut -d' ' -f1; }

if [ "${1:-}" = --check ]; then
    if grep -qx "inputs $(made_from)" "$state"; then exit 0; fi
    echo "The pictures in .pictures are older than shaders or scenes: bash examples/pictures.sh" >&2
    exit 1
fi

. .ci/packages.sh
install_missing $BUILD_PACKAGES $DEMO_PACKAGES
if [ ! -e build/CMakeCache.txt ]; then
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DOSGVOLUMIZER_BUILD_TESTS=OFF
fi
cmake --build build --target osgdb_serializers_osgvolumizer osgdb_volume osgvolumizerrender
export OSG_LIBRARY_PATH=$PWD/build/lib OSG_FILE_PATH=$PWD/data
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# draw NAME WIDTH HEIGHT SCENE [OPTION...]: at twice the size, for smooth edges.
draw() {
    local name=$1 width=$2 height=$3 scene=$4
    shift 4
    build/bin/osgvolumizerrender "$scene" --size $((2 * width)) $((2 * height)) --period 0.5 \
        --output "$work/$name.exr" "$@"
    oiiotool "$work/$name.exr" --iscolorspace sRGB --resize:filter=box "${width}x${height}" -o "$work/$name.exr"
}

draw mixed 1600 1000 data/mixed.osgt --background 0.09 0.10 0.14 1 \
    --eye -14 -247 9 --center 2 5 -8 --fovy 27
oiiotool "$work/mixed.exr" --iscolorspace sRGB --ch R,G,B -d uint8 -o .pictures/mixed.png

# Four looks of the same scan, side by side.
look() {
    local name=$1
    shift
    draw "$name" 400 420 data/head.osgt --background 0.09 0.10 0.14 1 \
        --eye -14 -247 9 --center 2 5 -10 --fovy 25 "$@"
}
look composited --shading off
look lit
look isosurface --ray isosurface --iso 24 --interpolation cubic
# Seen from the same place; without a scene the head is not moved to the origin, nor turned.
draw maximum 400 420 data/head.tif.volume -O "orientation=PIR ramp=0.32,0.6" --ray maximum \
    --shading off --background 0.09 0.10 0.14 1 --eye 100.4 -127.4 5 --center -41.5 66.65 -74.4 \
    --up -0.16 0.19 0.97 --fovy 25
oiiotool "$work"/{composited,lit,isosurface,maximum}.exr --mosaic 4x1 --iscolorspace sRGB --ch R,G,B -d uint8 \
    -o .pictures/looks.png

cat >"$state" <<END
Made by examples/pictures.sh.
date $(date -u +%F)
commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown) and what was changed since
inputs $(made_from)
END
echo "Drawn: .pictures/mixed.png .pictures/looks.png"
