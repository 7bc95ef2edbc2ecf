#!/usr/bin/env bash
# Pictures of what happens within one frame of the atrium in mode gi, as docs/gi-overview.md shows them, and of what the path-traced
# reference makes of the same view.
#   tools/pictures.sh [OPTION...] [OUTDIR]    OUTDIR: where the PNG files go; default tools/pictures
#     --scene SCENE        cornell, caustics or atrium; default atrium
#     --size WxH           default 480x270
#     --frames N           of the final picture and of the terms; default 32
#     --spp N              samples a pixel of the reference; default 512
#     --device NAME        as lumicut-play takes it
#     --preset NAME        of mode gi; default default
#     --set NAME=VALUE     a setting of mode gi; repeatable
#     --only NAME,...      these pictures alone
# Packages are kept in build/pictures. LUMICUT_BIN=FOLDER uses the programs there instead of building.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

scene=atrium size=480x270 frames=32 spp=512 preset=default only= out=$root/build/pictures
device=() settings=()
read_options scene= size= frames= spp= device++=device preset= set++=settings only= -- "$@"
pictures=${operands[0]:-$root/tools/pictures}
mkdir -p "$out" "$pictures"
build_programs
package=$(package_of "$scene")

# picture NAME OPTION...: plays the package into NAME.png.
picture() {
    local name=$1
    shift
    [[ -z $only || ,$only, == *,$name,* ]] || return 0
    echo "pictures.sh: rendering $name.png" >&2
    "$bin/lumicut-play" "$package" --headless --size "$size" ${device[@]+"${device[@]}"} "$@" --output "$pictures/$name.png" \
        2>"$out/$name.log" || { cat "$out/$name.log" >&2 && fail 4 "$name.png could not be rendered"; }
    echo "$pictures/$name.png"
}
gi() {
    picture "$@" --mode gi --preset "$preset" ${settings[@]+"${settings[@]}"}
}

# A view shows one frame: more shadow rays make the picture behind it smooth.
for view in normals budget samples clusters photons tree cut; do
    gi "$view" --view "$view" --set direct_samples=16
done
gi irradiance --view irradiance --frames "$frames"
gi caustics --set term=caustics --set exposure=4 --frames "$frames"
gi first --frames 1
gi final --frames "$frames"
picture reference --mode reference --spp "$spp"
