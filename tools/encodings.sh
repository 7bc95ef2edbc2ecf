#!/usr/bin/env bash
# Compares the pictures of a scene in other encodings (Draco, meshopt, quantized, WebP, KTX2, ...): compiles each file, renders
# mode gi from the same camera with the same seed, and prints how far each picture is from that of the first file.
#   tools/encodings.sh [OPTION...] FILE OTHER...
#     --size WxH         of the pictures; default 160x90
#     --frames N         of each picture; default 64
#     --preset NAME      of mode gi; default preview
#     --out DIR          packages, pictures and logs; default build/encodings
# Columns: mean ratio of each channel, relMSE, the file, and what it misses of the goals: ratios .99 to 1.01, relMSE 0.001.
# A file that is refused, or of which something was damaged (a texture that cannot be read, say), is named and not compared.
# Exit code 4 where a goal is missed. LUMICUT_BIN=FOLDER uses the programs there instead of building.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

size=160x90 frames=64 preset=preview out=$root/build/encodings
read_options size= frames= preset= out= -- "$@"
((${#operands[@]} >= 2)) || fail 1 "name a file and others (see --help)"
mkdir -p "$out"
build_programs

# damage_in REPORT: the first damaged item.
damage_in() {
    sed -n '/"message":/h; /"damage": true/{x; s/^ *"message": "\(.*\)",\{0,1\}$/\1/p; q}' "$1"
}

missed=0 first=
printf '%-8s %8s %8s %9s  %s\n' 'ratio R' G B relMSE file
for file in "${operands[@]}"; do
    name=$out/$(basename "$file")
    if ! "$bin/lumicut-compile" "$file" -q -f -o "$name.lumi" --report "$name.json" >"$name.log" 2>&1; then
        printf '%-36s  %s: refused: %s\n' '' "$file" "$(head -n 1 "$name.log" | sed 's/^.*: error: //')"
    elif grep -q '"damage": true' "$name.json"; then
        printf '%-36s  %s: damaged: %s\n' '' "$file" "$(damage_in "$name.json")"
    else
        "$bin/lumicut-play" "$name.lumi" --headless --mode gi --preset "$preset" --size "$size" --frames "$frames" \
            --output "$name.exr" >"$name.log" 2>&1 || { cat "$name.log" >&2 && fail 4 "$file could not be rendered"; }
        : "${first:=$name.exr}"
        "$bin/lumicut-compare" "$first" "$name.exr" --tsv >"$name.tsv"
        awk -v file="$file" '{
            missed = ""
            for (c = 1; c <= 3; ++c) if ($c < 0.99 || $c > 1.01) missed = ": ratio"
            if ($4 > 0.001) missed = missed ": relMSE"
            printf "%-8.4f %8.4f %8.4f %9.3g  %s%s\n", $1, $2, $3, $4, file, missed
            exit missed != "" }' "$name.tsv" || missed=1
    fi
done
((!missed)) || exit 4
