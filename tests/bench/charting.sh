# Sourced by chart.sh and mesh_chart.sh, which stand in this folder: run_chart PROGRAM NAME SUBJECT SCRIPT
# ARGUMENT... installs what is missing (Debian 12, root or sudo; without VTK a chart is drawn without it),
# builds PROGRAM, lets it measure everything in one process, round by round, and has the Python SCRIPT draw
# build/chart/NAME.svg and NAME.md from build/chart/NAME.csv. SUBJECT says what was drawn. ARGUMENTs go to
# the program.
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1
. .ci/packages.sh

run_chart() {
    local program=$1 name=$2 subject=$3 script=$4 rasteriser="" display=()
    shift 4
    install_missing $BUILD_PACKAGES $CHART_PACKAGES || exit 1
    install_missing $VTK_PACKAGES || echo "No VTK: its renderers are left out." >&2

    # The same rasteriser for all. Remove this line to measure a graphics card (and start an X server on
    # it, for VTK).
    export LIBGL_ALWAYS_SOFTWARE=1

    cmake -S . -B build/chart -G Ninja -DCMAKE_BUILD_TYPE=Release -DOSGVOLUMIZER_BUILD_TESTS=ON \
        -DOSGVOLUMIZER_BUILD_BENCH=ON -DOSGVOLUMIZER_BUILD_PLUGINS=OFF || exit 1
    cmake --build build/chart --target "$program" || exit 1

    [ -n "${DISPLAY:-}" ] || display=(xvfb-run -a -s "-screen 0 1280x1024x24")
    "${display[@]}" "build/chart/bin/$program" --csv "build/chart/$name.csv" "$@" || exit 1
    [ -z "${LIBGL_ALWAYS_SOFTWARE:-}" ] || rasteriser="Mesa's software rasteriser;"
    # What was measured, and on what, for the chart to say.
    {
        echo "# Commit $(git rev-parse --short HEAD 2>/dev/null || echo unknown), $(date -u +%F); $(nproc) cores,"
        echo "# $rasteriser"
        echo "# $subject"
        cat "build/chart/$name.csv"
    } >build/chart/run.csv
    mv build/chart/run.csv "build/chart/$name.csv"
    python3 -B "tests/bench/$script" "build/chart/$name.csv" build/chart || exit 1
    echo "build/chart/$name.svg  build/chart/$name.md  build/chart/$name.csv"
}
