#!/usr/bin/env bash
# Time against error of osgVolumizer and its peers: writes build/chart/chart.csv, chart.svg and chart.md
# (see charting.sh). Arguments go to the program, e.g.
#   tests/bench/chart.sh --scenes smooth,head --rounds 3
# A full run takes about an hour on two cores, half of it for references, which are kept in
# build/chart/chart. The CPUs should have nothing else to do.
set -u -o pipefail
. "$(dirname "${BASH_SOURCE[0]}")/charting.sh"
install_missing $CHART_VOLPACK_PACKAGES || echo "No VolPack: it is left out." >&2
install_missing $OPENVDB_PACKAGES || echo "No OpenVDB: its renderer is left out." >&2
run_chart osgVolumizerChart chart "512 x 512 pixels, 128^3 voxels unless stated" chart.py "$@"
