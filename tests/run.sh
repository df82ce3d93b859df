#!/usr/bin/env bash
# Installs what is missing (Debian 12, root or sudo), builds, and runs all tests: optimised, then
# under the address and undefined-behaviour sanitizers; then the fuzz targets, FUZZ_SECONDS each.
# Takes about an hour on two cores, and 3 GB in build/. On a bare Debian 12 it downloads 645 MB of
# packages, 425 MB where VTK cannot be had. The last line says what happened.
# TSAN=1 adds the test of threads under the thread sanitizer. Fails if anything fails, or if a test
# was skipped.
set -u -o pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 1
. .ci/packages.sh

export FUZZ_SECONDS=${FUZZ_SECONDS:-10}
export CTEST_PARALLEL_LEVEL=${CTEST_PARALLEL_LEVEL:-2}
jobs=$(nproc)
failures=()
passed= # how many tests, of each suite

# Mesa's software rasteriser gives the same pictures everywhere.
export LIBGL_ALWAYS_SOFTWARE=1

# run_suite PRESET: configures, builds and tests; a build that fails ends the script. With a compiler
# cache, which is empty on a fresh clone, each source would be compiled alone.
run_suite() {
    local preset=$1 log werror=ON binary=build
    [ "$preset" = release ] || binary=build/${preset%-ubsan}
    # GCC's flow analysis warns of things that cannot happen once code is instrumented.
    [ "$preset" = release ] || werror=OFF
    cmake --preset "$preset" -DOSGVOLUMIZER_BUILD_TESTS=ON -DOSGVOLUMIZER_BUILD_EXAMPLES=ON \
        -DOSGVOLUMIZER_BUILD_PLUGINS=ON -DOSGVOLUMIZER_WERROR=$werror \
        -DOSGVOLUMIZER_TEST_SHARDS=8 -DOSGVOLUMIZER_CCACHE=OFF || exit 1
    cmake --build --preset "$preset" -j "$jobs" || exit 1
    mkdir -p build/logs
    log=build/logs/ctest-$preset.log
    if ! ctest --preset "$preset" -j "$CTEST_PARALLEL_LEVEL" 2>&1 | tee "$log"; then
        # GCC 12's leak sanitizer crashes at exit on thread-local storage of some libraries that were
        # loaded late. Where that happened, what failed runs again without searching there.
        grep -aq 'LeakSanitizer has encountered a fatal error' "$log" &&
            echo "The leak sanitizer itself crashed in some of these; what failed runs again without the part that crashes."
        if ! grep -aq 'LeakSanitizer has encountered a fatal error' "$log" ||
            ! ctest --preset "$preset-without-tls" --rerun-failed 2>&1 | tee -a "$log"; then
            failures+=("$preset")
        fi
    fi
    # Programs of many tests, and tests that are programs or scripts.
    passed+="$preset $(awk '/^\[  PASSED  \] [0-9]+ test/ {n += $4; --n} /^Test Passed/ {++n} END {print n + 0}' \
        "$binary/Testing/Temporary/LastTest.log") tests, "
    if grep -aq '\*\*\*Skipped' "$log"; then
        echo "Tests were skipped in the $preset build:"
        grep -a '\*\*\*Skipped' "$log"
        failures+=("$preset (skipped tests)")
    fi
}

# fuzz_target NAME: from its folder under tests/fuzz/seeds, if there is one.
fuzz_target() {
    local name=$1 corpus=build/fuzz/corpus/$1 seeds=tests/fuzz/seeds/$1
    mkdir -p "$corpus"
    [ -d "$seeds" ] || seeds=
    echo "$name for $FUZZ_SECONDS s"
    "build/fuzz/bin/$name" -max_total_time="$FUZZ_SECONDS" -timeout=30 -rss_limit_mb=2048 -verbosity=0 \
        -artifact_prefix="$corpus/" "$corpus" $seeds
}
export -f fuzz_target

# Fuzz targets are programs named *Fuzz.
run_fuzz() {
    local target name
    cmake -S . -B build/fuzz -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++-14 \
        -DOSGVOLUMIZER_BUILD_TESTS=ON -DOSGVOLUMIZER_BUILD_FUZZ=ON \
        -DOSGVOLUMIZER_SANITIZE=fuzzer-no-link,address,undefined -DOSGVOLUMIZER_CCACHE=OFF || exit 1
    cmake --build build/fuzz -j "$jobs" --target fuzz || exit 1
    rm -f build/logs/*Fuzz.failed
    # As many at a time as there are cores; what each says comes when it is through.
    for target in build/fuzz/bin/*Fuzz; do
        basename "$target"
    done | xargs -P "$jobs" -I{} bash -c 'fuzz_target {} >build/logs/{}.log 2>&1 || touch build/logs/{}.failed'
    for target in build/fuzz/bin/*Fuzz; do
        name=$(basename "$target")
        cat "build/logs/$name.log"
        [ ! -e "build/logs/$name.failed" ] || failures+=("$name")
    done
}

install_missing $BUILD_PACKAGES $TEST_PACKAGES || exit 1
install_missing $TIFF_PACKAGES || echo "No libtiff: the reader of rarer TIFF is left out." >&2
install_missing $HDF5_PACKAGES || echo "No HDF5: the reader of its files is left out." >&2
install_missing $ITK_PACKAGES || echo "No ITK: the reader of DICOM and its like is left out." >&2
install_missing $ITK_TEST_PACKAGES || exit 1
install_missing $GDAL_PACKAGES || echo "No GDAL: the reader of NetCDF and Zarr is left out." >&2
install_missing $OPENVDB_PACKAGES || echo "No OpenVDB: the reader of its grids is left out." >&2
install_missing $VTK_PACKAGES || echo "No VTK: the readers of its files are left out." >&2

run_suite release
run_suite asan-ubsan
# The test of threads under the thread sanitizer, on demand: TSAN=1 bash tests/run.sh
if [ -n "${TSAN:-}" ]; then
    run_suite tsan
fi
run_fuzz

# One line at the end that says what happened.
if [ ${#failures[@]} -gt 0 ]; then
    grep -aE '^[0-9]+% tests passed|^\[  FAILED  \] [^0-9]' build/logs/ctest-*.log | sort -u
    echo "FAILED: ${failures[*]} (see build/logs)"
    exit 1
fi
echo "ALL PASSED: ${passed}$(ls build/fuzz/bin/*Fuzz | wc -l) fuzz targets."
