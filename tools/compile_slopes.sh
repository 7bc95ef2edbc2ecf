#!/usr/bin/env bash
# The cost of compiling by size: seconds by stage, peak memory and bytes for landscapes of 0.1, 1 and 5 million triangles.
#   tools/compile_slopes.sh [OUTDIR] [--sizes N,N,...] [--jobs N] [--scene FILE]
# --scene measures that scene instead: cold, unchanged, and compiled again from the cache.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bin=$root/build/release/bin
out=
sizes=100000,1000000,5000000
jobs=$(nproc)
scene=
while (($# > 0)); do
    case $1 in
    --sizes) sizes=$2; shift 2 ;;
    --jobs) jobs=$2; shift 2 ;;
    --scene) scene=$2; shift 2 ;;
    -*) echo "usage: tools/compile_slopes.sh [OUTDIR] [--sizes N,N,...] [--jobs N] [--scene FILE]" >&2; exit 1 ;;
    *) out=$1; shift ;;
    esac
done
if [[ -z $out ]]; then
    out=$(mktemp -d)
    trap 'rm -rf "$out"' EXIT
fi
mkdir -p "$out"

# row LABEL COMMAND...: one line of the table, from the summary that the compiler prints.
row() {
    local label=$1
    shift
    "$@" 2>"$out/messages" | awk -v label="$label" '
        $1 == "triangles" { triangles = $2 }
        $1 == "bytes" { bytes = $2 + 0 }
        $1 == "seconds" { seconds = $2 + 0; stages = substr($0, index($0, ":") + 2) }
        $1 == "memory" { memory = $2 }
        END { if (!triangles) exit 1
              printf "%10s %10d %8.2f %8.2f %8d %8d  %s\n", label, triangles, seconds, seconds / triangles * 1e6, memory,
                     bytes / 2 ^ 20, stages }' || { cat "$out/messages" >&2; exit 3; }
}

printf '%10s %10s %8s %8s %8s %8s  %s\n' scene triangles seconds us/tri 'peak MiB' MiB 'seconds by stage'
if [[ -n $scene ]]; then
    rm -rf "$out/cache"
    compile=("$bin/lumicut-compile" "$scene" -j "$jobs" -o "$out/scene.lumi" --cache "$out/cache")
    row cold "${compile[@]}" --force
    start=${EPOCHREALTIME/[.,]/}
    "${compile[@]}" >/dev/null
    echo "unchanged: $(((${EPOCHREALTIME/[.,]/} - start) / 1000)) ms"
    row cached "${compile[@]}" --force
    exit
fi
for size in ${sizes//,/ }; do
    "$bin/lumicut-scenes" "$out" --terrain "$size" >/dev/null
    row "$size" "$bin/lumicut-compile" "$out/terrain.glb" -f -j "$jobs" -o "$out/terrain.lumi"
done
