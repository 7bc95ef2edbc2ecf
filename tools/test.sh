#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test: a minute of fuzzing for each reader, then ctest.
# Fails where a test does; a missing Vulkan device is a failure too, never a skipped test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
tools/build.sh release
tools/build.sh asan fuzz_exr fuzz_gltf fuzz_hdr fuzz_ktx2 fuzz_package fuzz_seeds fuzz_settings

result=0
echo "test: fuzzing each reader for a minute"
ctest --preset asan --label-regex fuzz --parallel "$(nproc)" || result=1
# Tests of the GPU take turns (RESOURCE_LOCK gpu): a software device uses every core on its own.
echo "test: running all tests"
ctest --preset release --parallel "$(nproc)" || result=1
if ((result != 0)); then
    echo "test: failed" >&2
fi
exit $result
