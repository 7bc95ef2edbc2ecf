#!/usr/bin/env bash
# Prints the stripped size of the player and of every shared library it loads, and fails if it contains or loads
# any library of the compiler.
#   tools/size.sh [PLAYER]     default build/release/bin/lumicut-play
set -euo pipefail
player=${1:-$(dirname "${BASH_SOURCE[0]}")/../build/release/bin/lumicut-play}
if [[ ! -x $player ]]; then
    echo "size: error: there is no program $player; build it first with tools/build.sh release lumicut-play" >&2
    exit 1
fi

stripped=$(mktemp)
trap 'rm -f "$stripped"' EXIT
strip -o "$stripped" "$player"
printf '%10d  lumicut-play (stripped)\n' "$(stat -c %s "$stripped")"

# NAME and PATH of what the loader would load, libraries of libraries included; * marks what the player itself names.
needed=" $(readelf -d "$player" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | tr '\n' ' ')"
libraries=$(ldd "$player" | awk '$2 == "=>" { print $1, $3 }' | sort)
while read -r name path; do
    if [[ $path != /* ]]; then
        echo "size: error: the player needs $name, which is not installed" >&2
        exit 1
    fi
    mark=" "
    [[ $needed == *" $name "* ]] && mark="*"
    printf '%10d %s%s\n' "$(stat -L -c %s "$path")" "$mark" "$name"
done <<<"$libraries"
echo "(* named by the player itself; the others come with those)"

# Linked statically, a library still shows in the names of its types.
found=$(grep -iE 'embree|draco|openmesh|tinygltf|libtbb|libwebp' <<<"$libraries" || true)
found+=$(strings -a "$stripped" | grep -E '^N?K?(5draco|8OpenMesh|8tinygltf|3tbb)' || true)
if [[ -n $found ]]; then
    echo "size: error: the player carries what belongs to the compiler: ${found:0:500}" >&2
    exit 1
fi
