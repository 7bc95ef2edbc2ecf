#!/usr/bin/env bash
# Scenes that move: how true their first frames are, and what posing them costs.
#   tools/moving.sh [OPTION...] [OUTDIR]    OUTDIR: packages and pictures; default build/truth
#     --scenes A,B,...   of lumicut-scenes; default door,lamp,walker,ball
#     --times A,B,...    seconds of the animation; default 0.5,1.3
#     --preset NAME      of mode gi; default default
#     --spp N            samples a pixel of the references; default 2048
#     --size WxH         of the pictures; default 320x180
#     --boxes A,B,...    how many boxes move; default 1000,3000,10000
#     --tubes A,B,...    triangles of a skinned tube; default 10000,30000,100000
#     --frames N         timed at 1920x1080 for each; default 60; 0: none
# The first table compares the first frame of mode gi at a time with path tracing of the scene compiled as it is at that time:
# mean ratios of the channels, LDR-FLIP, and in brackets the ratios of the first frame of that static scene: where both are
# alike, nothing lags. The second one is milliseconds a frame: of posing on the GPU and on the CPU, and of all on the GPU.
# LUMICUT_BIN=FOLDER uses the programs there instead of building. Exit code 4 where something could not be rendered, else 0,
# whatever the errors.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

scenes=door,lamp,walker,ball times=0.5,1.3 preset=default spp=2048 size=320x180 boxes=1000,3000,10000 tubes=10000,30000,100000 frames=60
read_options scenes= times= preset= spp= size= boxes= tubes= frames= -- "$@"
out=${operands[0]:-$root/build/truth}
mkdir -p "$out"
build_programs

# play PACKAGE OUTPUT OPTION...: renders, or ends the script.
play() {
    local log=$out/moving.log
    "$bin/lumicut-play" "$1" --headless --size "$size" --output "$2" "${@:3}" 2>"$log" || { cat "$log" >&2 && fail 4 "$2 failed"; }
}

# figures REFERENCE PICTURE: ratios and LDR-FLIP
figures() {
    "$bin/lumicut-compare" "$1" "$2" --tsv | cut -f 1-3,6
}

printf '%-8s %7s  %7s %7s %7s %8s   (%s)\n' scene seconds 'ratio R' 'ratio G' 'ratio B' LDR-FLIP 'compiled as it is then'
for scene in ${scenes//,/ }; do
    "$bin/lumicut-scenes" "$out" "$scene" >&2
    "$bin/lumicut-compile" "$out/$scene.glb" -q -o "$out/$scene.lumi"
    for time in ${times//,/ }; do
        baked=$out/$scene-$time
        "$bin/lumicut-compile" "$out/$scene.glb" --time "$time" -q -o "$baked.lumi"
        play "$baked.lumi" "$baked-reference.exr" --mode reference --spp "$spp"
        play "$baked.lumi" "$baked-static.exr" --preset "$preset" --frames 1
        play "$out/$scene.lumi" "$baked-posed.exr" --preset "$preset" --frames 1 --time "$time"
        read -r r g b flip <<<"$(figures "$baked-reference.exr" "$baked-posed.exr")"
        read -r sr sg sb _ <<<"$(figures "$baked-reference.exr" "$baked-static.exr")"
        printf '%-8s %7s  %7.4f %7.4f %7.4f %8.4f   (%.4f %.4f %.4f)\n' "$scene" "$time" "$r" "$g" "$b" "$flip" "$sr" "$sg" "$sb"
    done
done
((frames > 0)) || exit 0

# cost KIND COUNT
cost() {
    "$bin/lumicut-scenes" "$out" "--$1" "$2" >&2
    "$bin/lumicut-compile" "$out/$1.glb" -f -q -o "$out/$1.lumi"
    "$bin/lumicut-bench" frame "$out/$1.lumi" --animation 0 --moving nothing --size 1920x1080 --frames "$frames" |
        awk -v kind="$1" -v count="$2" '$1 == "frame" { frame = $2 } $1 == "pose" { pose = $2 } /of it, posing/ { cpu = $(NF - 1) }
            END { if (pose == "") exit 1; printf "%-8s %8d  %8.3f %8.3f %8.2f\n", kind, count, pose, cpu, frame }' || fail 4 "$1 $2 failed"
}
printf '\n%-8s %8s  %8s %8s %8s\n' scene count 'pose ms' 'CPU ms' 'frame ms'
for count in ${boxes//,/ }; do cost boxes "$count"; done
for count in ${tubes//,/ }; do cost tube "$count"; done
