#!/usr/bin/env bash
# Configures a preset where that was not done yet, and builds.
#   tools/build.sh PRESET [TARGET...]     presets: release, debug, asan; without targets, everything
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# == 0)); then
    echo "usage: tools/build.sh PRESET [TARGET...]" >&2
    exit 1
fi
preset=$1
shift

# Ninja configures again by itself when a CMakeLists.txt changes, but not when the presets change.
if [[ ! -e build/$preset/build.ninja || CMakePresets.json -nt build/$preset/build.ninja ]]; then
    echo "build: configuring $preset"
    mkdir -p "build/$preset"
    if ! cmake --preset "$preset" >"build/$preset/configure.log" 2>&1; then
        cat "build/$preset/configure.log" >&2
        exit 1
    fi
fi
echo "build: building $preset${*:+: $*}"
cmake --build --preset "$preset" ${@:+--target "$@"}
