#!/usr/bin/env bash
# Shows data/mixed.osgt in stock osgviewer. Installs what is missing (Debian 12, root or sudo) and
# builds the libraries, the plugins and the render tool first. Where there is no display, osgviewer
# runs on a virtual one and the picture is written to a file.
#
#   bash examples/demo.sh [SCENE]        SCENE defaults to data/mixed.osgt
set -eu -o pipefail
start_dir=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
. .ci/packages.sh

scene=$root/data/mixed.osgt
if [ $# -gt 0 ]; then
    case $1 in /*) scene=$1 ;; *) scene=$start_dir/$1 ;; esac
fi
headless=no
if [ -z "${DISPLAY:-}" ] || [ -n "${CI:-}" ]; then headless=yes; fi

packages="$BUILD_PACKAGES $DEMO_PACKAGES"
[ $headless = yes ] && packages="$packages $HEADLESS_DEMO_PACKAGES"
install_missing $packages

# A build folder that is there already keeps its settings.
if [ ! -e build/CMakeCache.txt ]; then
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DOSGVOLUMIZER_BUILD_TESTS=OFF
fi
cmake --build build --target osgdb_serializers_osgvolumizer osgdb_volume osgvolumizerrender

# All that osgviewer needs to be told: where the plugins and the data are.
export OSG_LIBRARY_PATH=$root/build/lib${OSG_LIBRARY_PATH:+:$OSG_LIBRARY_PATH}
export LD_LIBRARY_PATH=$root/build/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export OSG_FILE_PATH=$root/data${OSG_FILE_PATH:+:$OSG_FILE_PATH}

if [ $headless = no ]; then
    exec osgviewer --samples 4 --window 60 60 1024 768 "$scene"
fi

picture=$root/build/demo.png
work=$(mktemp -d)
viewer=
server=
trap 'kill $viewer $server 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT

# Xvfb finds a free display by itself and writes its number.
Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp 3>"$work/display" 2>"$work/Xvfb.log" &
server=$!
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || { cat "$work/Xvfb.log" >&2; exit 1; }
export DISPLAY=:$(cat "$work/display")

osgviewer --samples 4 --window 0 0 1024 768 "$scene" >"$work/osgviewer.log" 2>&1 &
viewer=$!

# The picture is there when the screen is no longer of one colour and has stopped changing.
# A frame may take longer than a second, and the first ones may have fewer samples, as of a view that
# moves.
last=
same=0
for _ in $(seq 120); do
    sleep 1
    kill -0 $viewer 2>/dev/null || break
    import -silent -window root "$work/screen.png"
    colours=$(identify -format '%k' "$work/screen.png")
    now=$(identify -format '%#' "$work/screen.png")
    if [ "$now" = "$last" ]; then same=$((same + 1)); else same=0; fi
    if [ "$colours" -gt 16 ] && [ $same -ge 4 ]; then
        mv "$work/screen.png" "$picture"
        echo "No display: the picture is in $picture"
        # The drivers' own messages are none of the scene's.
        if grep -vE '^(libGL|MESA)' "$work/osgviewer.log" | grep -iE 'warning|error' >&2; then
            echo "osgviewer complained of $scene" >&2
            exit 1
        fi
        exit 0
    fi
    last=$now
done
cat "$work/osgviewer.log" >&2
echo "osgviewer showed nothing of $scene" >&2
exit 1
