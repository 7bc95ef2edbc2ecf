#!/bin/sh
# The window, on a virtual display: three validated frames, an exit code of 0 and a picture of the right size; and one
# sentence with exit code 4 where there is no display.
# window_test.sh LUMICUT_SCENES LUMICUT_COMPILE LUMICUT_PLAY
set -eu
scenes=$1 compile=$2 play=$3

fail() { echo "window_test: $*" >&2; exit 1; }
command -v xvfb-run >/dev/null || fail "xvfb-run is missing (Debian: xvfb xauth)"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$scenes" "$folder" cornell >/dev/null
"$compile" "$folder/cornell.glb" -o "$folder/cornell.lumi" >"$folder/compile.log" 2>&1 || fail "$(cat "$folder/compile.log")"

xvfb-run -a -s "-screen 0 1280x720x24" "$play" "$folder/cornell.lumi" --size 200x120 --frames 3 --validate \
    --output "$folder/picture.png" --stats "$folder/stats.json" 2>"$folder/play.log" || fail "exit code $?: $(cat "$folder/play.log")"
grep -q "validation:" "$folder/play.log" && fail "$(cat "$folder/play.log")"
grep -q '"samples_per_pixel": 3,' "$folder/stats.json" || fail "not 3 samples a pixel: $(cat "$folder/stats.json")"
# Signature, then the header chunk: length 13, "IHDR", width 200, height 120.
header=$(od -An -tx1 -N24 "$folder/picture.png" | tr -d ' \n')
[ "$header" = 89504e470d0a1a0a0000000d49484452000000c800000078 ] || fail "picture.png begins with $header"

# A path of one key: the camera stands there, and shows what a sequence shows of it.
cat >"$folder/path.json" <<END
{"schema": "lumicut-path/1", "keys": [{"time": 0, "position": [0.3, 1.2, 1], "forward": [-0.2, 0, -1]}]}
END
set -- "$folder/cornell.lumi" --size 200x120 --mode direct --path "$folder/path.json"
xvfb-run -a -s "-screen 0 1280x720x24" "$play" "$@" --frames 3 --output "$folder/path.png" 2>"$folder/play.log" ||
    fail "exit code $? with --path: $(cat "$folder/play.log")"
"$play" "$@" --headless --frames 0-0 --spp 3 --output "$folder/path-%d.png" 2>"$folder/play.log" || fail "$(cat "$folder/play.log")"
# Pixels alone: frames of a sequence also name what they were made from.
python3 - "$folder/path.png" "$folder/path-0.png" <<'END' || fail "the window does not show what --path says"
import struct
import sys


def pixels(path):
    with open(path, "rb") as file:
        data = file.read()
    at, kept = 8, b""  # after the signature
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind in (b"IHDR", b"IDAT"):
            kept += data[at + 8 : at + 8 + length]
        at += 12 + length
    return kept


sys.exit(pixels(sys.argv[1]) != pixels(sys.argv[2]))
END

code=0
env -u DISPLAY -u WAYLAND_DISPLAY "$play" "$folder/cornell.lumi" 2>"$folder/none.log" || code=$?
[ $code = 4 ] || fail "exit code $code without a display: $(cat "$folder/none.log")"
grep -q "there is no display.*--headless" "$folder/none.log" || fail "without a display it says: $(cat "$folder/none.log")"
