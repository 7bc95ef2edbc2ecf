#!/usr/bin/env bash
# The cost of compiling by size: seconds by stage, peak memory and bytes for landscapes of 0.1, 1 and 5 million triangles.
#   tools/compile_slopes.sh [OUTDIR] [--sizes N,N,...] [--jobs N] [--scene FILE]
# --scene measures that scene instead: cold, unchanged, compiled again from the cache, and (of a .glb) with one texture changed.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

sizes=100000,1000000,5000000
jobs=$(nproc)
scene=
read_options sizes= jobs= scene= -- "$@"
out=${operands[0]-}
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

# change_texture SCENE.glb CHANGED.glb: the same scene, its first image another one, of 512 x 512 random texels.
change_texture() {
    python3 - "$1" "$2" <<'EOF'
import json, random, struct, sys, zlib

data = open(sys.argv[1], "rb").read()
length = struct.unpack_from("<I", data, 12)[0]
scene, binary = json.loads(data[20:20 + length]), data[28 + length:]
side = 512
texels = b"".join(b"\0" + random.Random(y).randbytes(3 * side) for y in range(side))
chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
png = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)) +
       chunk(b"IDAT", zlib.compress(texels, 1)) + chunk(b"IEND", b""))
binary += b"\0" * (-len(binary) % 4)
scene["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(png)})
scene["images"][0] = {"bufferView": len(scene["bufferViews"]) - 1, "mimeType": "image/png"}
binary += png + b"\0" * (-len(png) % 4)
scene["buffers"][0]["byteLength"] = len(binary)
text = json.dumps(scene).encode()
text += b" " * (-len(text) % 4)
with open(sys.argv[2], "wb") as out:
    out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)))
    out.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
EOF
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
    if [[ $scene == *.glb ]]; then
        change_texture "$scene" "$out/changed.glb"
        row 'a texture' "$bin/lumicut-compile" "$out/changed.glb" -j "$jobs" -o "$out/scene.lumi" --cache "$out/cache"
    fi
    exit
fi
for size in ${sizes//,/ }; do
    "$bin/lumicut-scenes" "$out" --terrain "$size" >/dev/null
    row "$size" "$bin/lumicut-compile" "$out/terrain.glb" -f -j "$jobs" -o "$out/terrain.lumi"
done
