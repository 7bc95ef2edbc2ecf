#!/usr/bin/env bash
# Renders a sequence of lumicut-play three times, and compares the bytes of its frames: whole, in pieces that start in any order, and
# with players that are killed in the middle and started again.
#   tools/split_sequence.sh [OPTION...] [OUTDIR]    OUTDIR: packages and frames; default build/split
#     --scene NAME       of tools/bench/scenes.sh, or a .lumi file; default cornell
#     --path FILE        camera path; default: of cornell one through the box; without one what moves in the package plays
#     --frames N         of the sequence; default 240
#     --pieces N         default 4
#     --kills N          players that are killed, by turns with SIGTERM and SIGKILL; default 6
#     --fps N            default 30
#     --size WxH         default 48x32
#     --preset NAME      of mode gi; default preview
#     --set NAME=VALUE   a setting; repeatable
#     --device NAME      default the best suitable one
# Exit code 4 where frames differ or a player failed. LUMICUT_BIN=FOLDER uses the programs there instead of building.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

scene=cornell path='' frames=240 pieces=4 kills=6 fps=30 size=48x32 preset=preview options=()
read_options scene= path= frames= pieces= kills= fps= size= preset= set++=options device++=options -- "$@"
for number in "$frames" "$pieces" "$kills"; do
    [[ $number =~ ^[0-9]+$ ]] || fail 1 "counts are whole numbers (see --help)"
done
((frames >= 1 && pieces >= 1 && pieces <= frames)) || fail 1 "there are 1 to $frames pieces"
out=${operands[0]:-$root/build/split}
mkdir -p "$out"
build_programs
package=$scene
[[ $scene == *.lumi ]] || package=$(package_of "$scene")
[[ -e $package ]] || fail 1 "there is no package of $scene"
if [[ $scene == cornell && -z $path ]]; then
    path=$out/path.json
    cat >"$path" <<'JSON'
{"schema": "lumicut-path/1", "keys": [{"time": 0, "camera": 0}, {"time": 4, "position": [0.2, 0.6, 1.2], "forward": [-0.2, 0, -1]},
 {"time": 8, "camera": 0}]}
JSON
fi
[[ -z $path ]] || options+=(--path "$path")

# play FOLDER FIRST LAST: renders what is missing of these frames. Its messages are in FOLDER.log.
play() {
    exec "$bin/lumicut-play" "$package" --headless --frames "$2-$3" --fps "$fps" --size "$size" --preset "$preset" \
        --output "$out/$1/frame-%04d.exr" ${options[@]+"${options[@]}"} >>"$out/$1.log" 2>&1
}

# begin FOLDER
begin() {
    rm -rf "${out:?}/$1" "$out/$1.log"
    mkdir "$out/$1"
}

count_of() {
    find "$out/$1" -name 'frame-*.exr' | wc -l
}

# same FOLDER: as whole?
same() {
    if diff -r "$out/whole" "$out/$1" >"$out/$1.diff"; then
        echo "$1: $(count_of "$1") frames, the same bytes"
    else
        fail 4 "$1: frames differ from those rendered whole, see $out/$1.diff"
    fi
}

last=$((frames - 1))
begin whole
(play whole 0 "$last") || fail 4 "a player failed, see $out/whole.log"
(($(count_of whole) == frames)) || fail 4 "frames are missing"
echo "whole: $frames frames of $size, $(find "$out/whole" -name '*.exr' -exec sha256sum {} + | cut -c 1-64 | sort -u | wc -l) of them different"

begin pieces
for ((piece = pieces - 1; piece >= 0; --piece)); do # the last one first
    (play pieces $((frames * piece / pieces)) $((frames * (piece + 1) / pieces - 1))) || fail 4 "a player failed, see $out/pieces.log"
done
same pieces

begin killed
killed=0
for ((i = 0; i < kills; ++i)); do
    play killed 0 "$last" &
    player=$!
    before=$(count_of killed)
    while kill -0 "$player" 2>/dev/null && (($(count_of killed) < before + 1 + i % 3)); do
        sleep 0.02
    done
    signal=$( ((i % 2)) && echo KILL || echo TERM)
    if kill -s "$signal" "$player" 2>/dev/null; then
        killed=$((killed + 1))
    fi
    wait "$player" 2>/dev/null || true
done
rm -f "$out"/killed/*.tmp # what SIGKILL left
(play killed 0 "$last") || fail 4 "a player failed, see $out/killed.log"
echo "killed: $killed players"
same killed
