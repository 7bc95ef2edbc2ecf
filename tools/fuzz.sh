#!/usr/bin/env bash
# Fuzzes every reader under the address and undefined-behaviour sanitizers, as many side by side as there are cores.
#   tools/fuzz.sh [SECONDS] [TARGET...]     600 seconds each and all targets by default: exr gltf hdr ktx2 package path settings
# Findings stay in build/asan/tests/fuzz: corpus/TARGET, and crash-*, timeout-* where it failed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

seconds=${1-600}
targets=("${@:2}")
((${#targets[@]} > 0)) || targets=(exr gltf hdr ktx2 package path settings)
if [[ ! $seconds =~ ^[1-9][0-9]*$ ]]; then
    echo "usage: tools/fuzz.sh [SECONDS] [TARGET...]" >&2
    exit 1
fi

tools/build.sh asan fuzz_seeds "${targets[@]/#/fuzz_}"
folder=build/asan/tests/fuzz
build/asan/bin/fuzz_seeds "$folder/seeds"

fuzz() {
    mkdir -p "$folder/corpus/$1"
    if build/asan/bin/fuzz_"$1" -max_total_time="$seconds" -max_len=131072 -timeout=10 -rss_limit_mb=2048 -detect_leaks=0 \
        -print_final_stats=1 -artifact_prefix="$folder/" "$folder/corpus/$1" "$folder/seeds/$1" >"$folder/$1.log" 2>&1; then
        echo "fuzz: $1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$folder/$1.log") runs, nothing found"
    else
        echo "fuzz: $1 failed; $folder/$1.log ends with:" >&2
        tail -n 30 "$folder/$1.log" >&2
        return 1
    fi
}
export -f fuzz
export folder seconds
echo "fuzz: $seconds seconds each: ${targets[*]}"
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I TARGET bash -c 'fuzz TARGET'
