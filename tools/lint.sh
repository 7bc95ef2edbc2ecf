#!/usr/bin/env bash
# Checks the formatting of all C++ files (.clang-format), then runs clang-tidy (.clang-tidy).
#   tools/lint.sh              clang-tidy on the C++ files that differ from the branch main
#   tools/lint.sh FILE...      clang-tidy on these; a folder stands for the files in it
#   tools/lint.sh --format     formatting only
#   tools/lint.sh --fix        formats all C++ files in place, and checks nothing
# clang-tidy reads the compile commands of build/release: configure and build that preset first. Exit code 1: something was found.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
    echo "lint: error: $*" >&2
    exit 2
}
mapfile -t sources < <(git ls-files '*.cpp' '*.h')
case ${1-} in
--help | -h) sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}" && exit ;;
--fix) printf '%s\0' "${sources[@]}" | xargs -0 clang-format-14 -i && exit ;;
esac

result=0
echo "lint: checking the formatting of ${#sources[@]} files"
printf '%s\0' "${sources[@]}" | xargs -0 -P "$(nproc)" -n 32 clang-format-14 --dry-run -Werror || result=1
((result == 0)) || echo "lint: tools/lint.sh --fix formats them" >&2
[[ ${1-} != --format ]] || exit $result

if (($#)); then
    mapfile -t checked < <(git ls-files -- "$@" | grep '\.cpp$')
else
    git rev-parse --verify --quiet main >/dev/null || fail "there is no branch main to compare with; name the files"
    mapfile -t checked < <(git diff --name-only --diff-filter=d "$(git merge-base main HEAD)" -- '*.cpp')
fi
if ((${#checked[@]})); then
    [[ -e build/release/compile_commands.json ]] || fail "build/release is not configured; run tools/build.sh release"
    echo "lint: running clang-tidy on ${#checked[@]} files"
    # Our headers, but none that the build generates.
    printf '%s\0' "${checked[@]}" |
        xargs -0 -P "$(nproc)" -n 1 clang-tidy-14 --quiet -p build/release --header-filter="^$PWD/(compiler|format|image|runtime|shaders|tests|tools)/" ||
        result=1
fi
exit $result
