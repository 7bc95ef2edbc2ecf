#!/usr/bin/env bash
# Compiles and renders every glTF file below folders, and prints the result of each.
#   tools/sweep.sh [OPTION...] DIR...
#     -j N, --jobs N     files at a time; default as many as there are processors
#     --size WxH         of the pictures; default 96x54
#     --frames N         of each picture; default 4
#     --mode MODE        of them, as lumicut-play takes it; default gi. On software Vulkan, preparing kernels for mode
#                        reference takes a fifth of the time, and 32 frames are few enough
#     --timeout SECONDS  for each compilation and each picture; default 60
#     --largest MB       leaves out files that are larger, with the buffers and images in their folder; default 200
#     --no-pictures      compiles only
#     --out DIR          packages' reports, logs, pictures and sheet.png; default build/sweep
# A row: number, result, triangles, seconds and bytes of the package, items that were damaged, file, and why it was refused.
# Results: ok; repaired (damaged items were replaced, with warnings); refused; crashed; timeout; dark (compiled, no picture).
# sheet.png shows the pictures under their numbers. Where FILE.report.json of glTF-Validator lies beside a file, a last list
# names files with errors in it that were compiled without a warning about damage.
# Exit code 4 where anything crashed or ran out of time, else 0. LUMICUT_BIN=FOLDER uses the programs there instead of building.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

jobs=$(nproc) size=96x54 frames=4 mode=gi timeout=60 largest=200 no_pictures=0 out=$root/build/sweep
read_options j=jobs jobs= size= frames= mode= timeout= largest= no-pictures out= -- "$@"
((${#operands[@]})) || fail 1 "name a folder (see --help)"
[[ -n ${LUMICUT_BIN-} ]] || "$root/tools/build.sh" release lumicut-compile lumicut-play lumicut-sheet >&2
rm -rf "$out/rows" "$out/pictures"
mkdir -p "$out/rows" "$out/pictures"

# json_number KEY FILE: the first one of that key in a report.
json_number() {
    sed -n "s/^ *\"$1\": *\([0-9.e+-]*\),\{0,1\}$/\1/p" "$2" | head -n 1
}

# ended CODE: how a program with that exit code ended.
ended() {
    case $1 in
    0) echo ok ;;
    124 | 137) echo timeout ;;
    [1-5]) echo refused ;;
    *) echo crashed ;;
    esac
}

# sweep_one NUMBER FILE: writes the file's row, tab-separated.
sweep_one() {
    local number=$1 file=$2 base=$out/rows/$1 code=0 result reason= triangles=- seconds=- bytes=- damaged=-
    timeout -k 5 "$timeout" "$bin/lumicut-compile" "$file" -q -o "$base.lumi" --report "$base.json" >"$base.log" 2>&1 || code=$?
    result=$(ended "$code")
    if [[ $result == ok ]]; then
        triangles=$(json_number triangles "$base.json")
        seconds=$(json_number total_seconds "$base.json" | cut -c 1-6)
        bytes=$(stat -c %s "$base.lumi")
        damaged=$(grep -c '"damage": true' "$base.json" || true)
        ((damaged == 0)) || result=repaired
        if ((!no_pictures)); then
            code=0
            timeout -k 5 "$timeout" "$bin/lumicut-play" "$base.lumi" --headless --size "$size" --frames "$frames" --mode "$mode" \
                --preset preview --output "$out/pictures/$number.png" >"$base.log" 2>&1 || code=$?
            case $(ended "$code") in
            ok) ;;
            refused) result=dark reason="lumicut-play ends with $code: $(tail -n 1 "$base.log")" ;;
            *) result=$(ended "$code") reason="lumicut-play ends with $code" ;;
            esac
        fi
    elif [[ $result == refused ]]; then
        reason=$(head -n 1 "$base.log" | sed 's/^.*: error: //' | cut -c 1-160)
    else
        reason="lumicut-compile ends with $code"
    fi
    rm -f "$base.lumi"
    printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$number" "$result" "$triangles" "$seconds" "$bytes" "$damaged" "$file" "$reason" \
        >"$base.row"
}
export -f sweep_one ended json_number
export out bin timeout size frames mode no_pictures

files=$(find "${operands[@]}" -type f \( -iname '*.gltf' -o -iname '*.glb' \) -size "-$((largest * 1024))k" | LC_ALL=C sort)
[[ -n $files ]] || fail 2 "there are no glTF files below ${operands[*]}"
nl -n rz -w 4 <<<"$files" | tr '\t\n' '\0\0' | xargs -0 -n 2 -P "$jobs" bash -c 'sweep_one "$@"' _

printf '%-4s %-8s %10s %8s %11s %7s  %s\n' no. result triangles seconds bytes damaged file
cat "$out"/rows/*.row | while IFS=$'\t' read -r number result triangles seconds bytes damaged file reason; do
    printf '%-4s %-8s %10s %8s %11s %7s  %s%s\n' "$number" "$result" "$triangles" "$seconds" "$bytes" "$damaged" "$file" \
        "${reason:+: $reason}"
done
if compgen -G "$out/pictures/*.png" >/dev/null; then
    "$bin/lumicut-sheet" "$out"/pictures/*.png --columns 16 -o "$out/sheet.png" && echo "pictures: $out/sheet.png"
fi
unnoticed=0 judged=0
while IFS=$'\t' read -r number result _ _ _ _ file _; do
    [[ -f $file.report.json ]] || continue
    judged=$((judged + 1))
    errors=$(json_number numErrors "$file.report.json")
    [[ $result == ok && ${errors:-0} != 0 ]] || continue
    unnoticed=$((unnoticed + 1))
    echo "unnoticed: $file: $(sed -n 's/^ *"code": "\(.*\)",$/\1/p' "$file.report.json" | sort -u | tr '\n' ' ')"
done < <(cat "$out"/rows/*.row)
count() { cut -f 2 "$out"/rows/*.row | grep -c "^$1$" || true; }
echo "$(wc -l <<<"$files") files: $(count ok) ok, $(count repaired) repaired, $(count refused) refused, $(count dark) dark," \
    "$(count timeout) timeout, $(count crashed) crashed; $judged with a validator's report, $unnoticed of them unnoticed"
(($(count crashed) + $(count timeout) == 0)) || exit 4
