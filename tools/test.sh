#!/usr/bin/env bash
# Installs what is missing, builds everything, checks the formatting and runs every test: a minute of fuzzing for each reader, then ctest.
# Fails where a test does; a missing Vulkan device is a failure too, never a skipped test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
tools/build.sh release
tools/build.sh asan fuzz_exr fuzz_gltf fuzz_hdr fuzz_ktx2 fuzz_package fuzz_path fuzz_seeds fuzz_settings

rm -f build/{asan,release}/Testing/Temporary/LastTestsFailed.log
failed=()
tools/lint.sh --format || failed+=("formatting (tools/lint.sh --fix mends it)")
echo "test: fuzzing each reader for a minute"
ctest --preset asan --label-regex fuzz --parallel "$(nproc)" || failed+=("fuzzing (build/asan/Testing/Temporary/LastTest.log)")
# Tests of the GPU take turns (RESOURCE_LOCK gpu): a software device uses every core on its own.
echo "test: running all tests"
ctest --preset release --parallel "$(nproc)" || failed+=("tests (build/release/Testing/Temporary/LastTest.log)")
if ((${#failed[@]} > 0)); then
    printf 'test: failed: %s\n' "${failed[@]}" >&2
    for log in build/{asan,release}/Testing/Temporary/LastTestsFailed.log; do
        [[ ! -s $log ]] || sed 's/^/test: failed: /' "$log" >&2
    done
    exit 1
fi
