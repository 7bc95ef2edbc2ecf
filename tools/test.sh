#!/usr/bin/env bash
# Installs what is missing, builds everything, checks the formatting and runs every test: a minute of fuzzing for each reader, then ctest.
# Prints at its end how many seconds each of these took, and the tests that took longest. Fails where a test does; a missing Vulkan device is a failure too, never a skipped test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

times=()
# phase NAME COMMAND...: runs it, notes its seconds.
phase() {
    local name=$1 start=$SECONDS status=0
    shift
    "$@" || status=$?
    times+=("$(printf '%5d s  %s' $((SECONDS - start)) "$name")")
    return $status
}
# Seconds of the tests of a JUnit file: the ten longest, and what is left.
test_times() {
    sed -n 's/.*<testcase name="\([^"]*\)".* time="\([0-9.]*\)".*/\2 \1/p' "$1" | sort -rn | awk '
        NR <= 10 { printf "test: %11.0f s  %s\n", $1, $2; next }
        { rest += $1; ++count }
        END { if (count) printf "test: %11.0f s  %d other tests\n", rest, count }'
}
print_times() {
    printf 'test: %s\n' "${times[@]}" "$(printf '%5d s  all' "$SECONDS")"
    [[ ! -s $results ]] || test_times "$results"
}
results=$PWD/build/release/Testing/results.xml
rm -f "$results"
trap print_times EXIT

phase "set-up" tools/setup.sh
phase "build" tools/build.sh release
phase "build with sanitizers" tools/build.sh asan fuzz_exr fuzz_gltf fuzz_hdr fuzz_ktx2 fuzz_package fuzz_path fuzz_seeds fuzz_settings

rm -f build/{asan,release}/Testing/Temporary/LastTestsFailed.log
failed=()
phase "formatting" tools/lint.sh --format || failed+=("formatting (tools/lint.sh --fix mends it)")
echo "test: fuzzing each reader for a minute"
phase "fuzzing" ctest --preset asan --label-regex fuzz --parallel "$(nproc)" || failed+=("fuzzing (build/asan/Testing/Temporary/LastTest.log)")
# Tests of the GPU take turns (RESOURCE_LOCK gpu): a software device uses every core on its own.
echo "test: running all tests"
phase "tests" ctest --preset release --parallel "$(nproc)" --output-junit "$results" || failed+=("tests (build/release/Testing/Temporary/LastTest.log)")
if ((${#failed[@]} > 0)); then
    printf 'test: failed: %s\n' "${failed[@]}" >&2
    for log in build/{asan,release}/Testing/Temporary/LastTestsFailed.log; do
        [[ ! -s $log ]] || sed 's/^/test: failed: /' "$log" >&2
    done
    exit 1
fi
