# Sourced by tests/run.sh and examples/demo.sh: install_missing PACKAGE... installs those Debian
# packages that are not there, and calls apt-get only if there are any.

BUILD_PACKAGES="g++ cmake ninja-build libopenscenegraph-dev libglm-dev libopenimageio-dev openimageio-tools libegl-dev libopengl-dev libegl-mesa0"

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
