#!/usr/bin/env bash
# Time against error of osgVolumizer and its peers: installs what is missing (Debian 12, root or sudo;
# without VTK the chart is drawn without it), builds, measures everything in one process, round by
# round, and writes build/chart/chart.csv, chart.svg and chart.md. Arguments go to the program, e.g.
#   tests/bench/chart.sh --scenes smooth,head --rounds 3
# A full run takes about three quarters of an hour on two cores, half of it for references, which are
# kept in build/chart/chart. The CPUs should have nothing else to do.
set -u -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
. .ci/packages.sh

install_missing $BUILD_PACKAGES $CHART_PACKAGES || exit 1
install_missing $VTK_PACKAGES || echo "No VTK: its two ray casters are left out." >&2

# The same rasteriser for all. Remove this line to measure a graphics card (and start an X server on
# it, for VTK).
export LIBGL_ALWAYS_SOFTWARE=1

cmake -S . -B build/chart -G Ninja -DCMAKE_BUILD_TYPE=Release -DOSGVOLUMIZER_BUILD_TESTS=ON \
    -DOSGVOLUMIZER_BUILD_BENCH=ON -DOSGVOLUMIZER_BUILD_PLUGINS=OFF || exit 1
cmake --build build/chart --target osgVolumizerChart || exit 1

display=()
[ -n "${DISPLAY:-}" ] || display=(xvfb-run -a -s "-screen 0 1280x1024x24")
"${display[@]}" build/chart/bin/osgVolumizerChart --csv build/chart/chart.csv "$@" || exit 1
# What was measured, and on what, for the chart to say.
{
    echo "# Commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown), $(date -u +%F); $(nproc) cores,"
    echo "# ${LIBGL_ALWAYS_SOFTWARE:+Mesa's software rasteriser;}"
    echo "# 512 x 512 pixels, 128^3 voxels unless stated"
    cat build/chart/chart.csv
} >build/chart/run.csv
mv build/chart/run.csv build/chart/chart.csv
python3 tests/bench/chart.py build/chart/chart.csv build/chart || exit 1
echo "build/chart/chart.svg  build/chart/chart.md  build/chart/chart.csv"
