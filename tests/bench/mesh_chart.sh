#!/usr/bin/env bash
# Time and error of osgVolumizer and VTK with unstructured grids of 10^4 to 10^6 tetrahedra: writes
# build/chart/mesh.csv, mesh.svg and mesh.md (see charting.sh). Arguments go to the program, e.g.
#   tests/bench/mesh_chart.sh --scenes smooth --sizes 13,27 --rounds 3
# A full run takes about half an hour on two cores, which should have nothing else to do.
set -u -o pipefail
. "$(dirname "${BASH_SOURCE[0]}")/charting.sh"
run_chart osgVolumizerMeshChart mesh "512 x 512 pixels" mesh_chart.py "$@"
