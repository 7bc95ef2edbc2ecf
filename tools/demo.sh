#!/usr/bin/env bash
# From a fresh clone to a picture: installs what is missing, builds, makes the atrium and plays it, in a window where
# there is a display, else into demo/atrium.png. Does again only what is out of date.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bin=build/release/bin
scene=demo/atrium.glb
package=demo/atrium.lumi
picture=demo/atrium.png

tools/setup.sh
tools/build.sh release lumicut-compile lumicut-play lumicut-scenes

mkdir -p demo
if [[ ! -e $scene || $bin/lumicut-scenes -nt $scene ]]; then
    echo "demo: generating the scene"
    $bin/lumicut-scenes demo atrium
fi
if [[ ! -e $package || $scene -nt $package || $bin/lumicut-compile -nt $package ]]; then
    echo "demo: compiling the scene"
    $bin/lumicut-compile $scene -o $package
fi

if [[ -n ${DISPLAY-}${WAYLAND_DISPLAY-} ]]; then
    echo "demo: playing $package in a window"
    if $bin/lumicut-play $package; then
        echo "demo: done; play it again with $bin/lumicut-play $package"
        exit
    fi
    echo "demo: no window could be had; rendering a picture instead"
fi
echo "demo: rendering $picture"
$bin/lumicut-play $package --headless --size 480x270 --frames 64 --output $picture
echo "demo: the picture is $PWD/$picture"
