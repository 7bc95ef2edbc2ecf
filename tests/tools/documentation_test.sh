#!/usr/bin/env bash
# Manual pages and completions contain every option of their program, and man, bash, zsh and fish parse them.
# documentation_test.sh PROGRAM...
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
result=0
complain() {
    echo "$*" >&2
    result=1
}

for program in "$@"; do
    name=$(basename "$program")
    "$program" --manual >"$folder/$name.1"
    for shell in bash zsh fish; do
        "$program" --completion $shell >"$folder/$name.$shell"
    done
    helps=$("$program" --help)
    for command in $(awk '/^Subcommands:/ { on = 1; next } on && NF { print $1 }' <<<"$helps"); do
        helps+=$'\n'$("$program" "$command" --help)
    done
    for option in $(grep -oE '^ +(-[a-z],)?--[a-z-]+' <<<"$helps" | grep -oE -- '--[a-z-]+' | sort -u); do
        grep -qF -- "${option//-/\\-}" "$folder/$name.1" || complain "$name's manual page lacks $option"
        for file in bash zsh; do
            grep -qE -- "$option($|[^a-z-])" "$folder/$name.$file" || complain "$name's $file completion lacks $option"
        done
        grep -qE -- " -l ${option#--}( |$)" "$folder/$name.fish" || complain "$name's fish completion lacks $option"
    done
    bash -n "$folder/$name.bash" || complain "bash does not understand its completion of $name"
    for shell in zsh fish; do
        ! command -v $shell >/dev/null || $shell -n "$folder/$name.$shell" ||
            complain "$shell does not understand its completion of $name"
    done
    if command -v groff >/dev/null; then
        said=$(groff -man -ww -Tutf8 -z "$folder/$name.1" 2>&1 || true)
        [[ -z $said ]] || complain "groff on $name's manual page: $said"
    fi
done

# What bash offers after "lumicut-pkg info --format " and after "lumicut-pkg d".
complete_words() {
    COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
    _lumicut_pkg
    echo "${COMPREPLY[*]}"
}
if [[ -e $folder/lumicut-pkg.bash ]]; then
    # shellcheck disable=SC1091
    source "$folder/lumicut-pkg.bash"
    [[ $(complete_words lumicut-pkg info --format '') == "json text" ]] || complain "no values are offered"
    [[ $(complete_words lumicut-pkg d) == diff ]] || complain "no commands are offered"
    [[ $(complete_words lumicut-pkg extract --o) == --output ]] || complain "no options are offered"
fi
exit $result
