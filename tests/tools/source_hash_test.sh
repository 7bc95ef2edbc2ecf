#!/usr/bin/env bash
# The hash of sources by which pictures tell players apart: of names and contents, wherever they lie.
# source_hash_test.sh CMAKE HEADER     HEADER: the player's, as built
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
result=0
complain() {
    echo "$*" >&2
    result=1
}
# hash_of TREE: of its sources, the folders in the order of runtime/CMakeLists.txt.
hash_of() {
    "$cmake" -DOUTPUT="$folder/hash.h" \
        -DFOLDERS="$1/runtime/frame,$1/runtime/gpu,$1/runtime/stages,$1/runtime,$1/format,$1/image" -P "$root/tools/source_hash.cmake"
    grep -o '"[0-9a-f]*"' "$folder/hash.h"
}
cmake=$1 built=$(grep -o '"[0-9a-f]*"' "$2")
mkdir "$folder/tree"
cp -r "$root/runtime" "$root/format" "$root/image" "$folder/tree"
touch "$folder/tree/runtime/renderer.cpp" # dates are of no account
[[ $(hash_of "$folder/tree") == "$built" ]] || complain "sources elsewhere have another hash than those that were built"
while read -r source; do
    echo "// changed" >>"$source"
    [[ $(hash_of "$folder/tree") != "$built" ]] || complain "a change of ${source#"$folder/tree/"} goes unnoticed"
    sed -i '$ d' "$source"
done < <(printf "$folder/tree/%s\n" runtime/frame/plan.cpp runtime/scene_lights.cpp runtime/stages/pose.cpp runtime/gpu/recorder.h format/light_table.cpp format/package.fbs)
[[ $(hash_of "$folder/tree") == "$built" ]] || complain "the sources have not come back"
mv "$folder/tree/runtime/renderer.cpp" "$folder/tree/runtime/rendered.cpp"
[[ $(hash_of "$folder/tree") != "$built" ]] || complain "a name goes unnoticed"
exit $result
