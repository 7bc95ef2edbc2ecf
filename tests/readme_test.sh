#!/usr/bin/env bash
# README.md names every package that tools/setup.sh installs and every option that the programs' --help lists.
# readme_test.sh PROGRAM...
set -euo pipefail
readme=$(<"$(dirname "${BASH_SOURCE[0]}")/../README.md")
result=0

while read -r package; do
    [[ $readme == *"\`$package\`"* ]] || { echo "README.md does not name the package $package" >&2; result=1; }
done < <("$(dirname "${BASH_SOURCE[0]}")/../tools/setup.sh" --list)

for program in "$@"; do
    options=$("$program" --help | grep -oE '^ +(-[a-z],)?--[a-z-]+' | grep -oE -- '--[a-z-]+')
    [[ -n $options ]] || { echo "$program --help lists no options" >&2; result=1; }
    for option in $options; do
        [[ $option == --help || $option == --version || $readme == *"$option"[^a-z-]* ]] ||
            { echo "README.md does not name $option of $(basename "$program")" >&2; result=1; }
    done
done
exit $result
