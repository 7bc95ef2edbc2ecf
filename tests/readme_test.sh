#!/usr/bin/env bash
# The documents agree with the programs and the tree: every relative link leads somewhere, docs/building.md names every package
# that tools/setup.sh installs, docs/cli.md every option of the programs and no other, and every setting that a document names
# exists.
# readme_test.sh PROGRAM...     lumicut-play among them, which lists the settings
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
result=0
complain() {
    echo "$*" >&2
    result=1
}
cd "$root"
documents=(README.md CHANGELOG.md docs/*.md format/*.md tools/*/README.md)

# anchors FILE: the names by which forges link to its headings.
anchors() {
    grep -E '^#+ ' "$1" | sed -E 's/^#+ +//' | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}
for document in "${documents[@]}"; do
    folder=$(dirname "$document")
    while read -r link; do
        file=${link%%#*} anchor=
        [[ $link != *"#"* ]] || anchor=${link#*#}
        [[ $link == *://* ]] && continue
        target=$folder/$file
        [[ -n $file ]] || target=$document
        [[ -e $target ]] || { complain "$document links to $link, which does not exist"; continue; }
        [[ -z $anchor ]] || anchors "$target" | grep -qxF -- "$anchor" || complain "$document links to $link: no such heading"
    done < <(grep -oE '\]\([^)]+\)' "$document" | sed -E 's/^\]\(//; s/\)$//')
done

building=$(<docs/building.md)
while read -r package; do
    [[ $building == *"\`$package\`"* ]] || complain "docs/building.md does not name the package $package"
done < <(tools/setup.sh --list)

cli=$(<docs/cli.md)
options=" --help --version "
settings=
for program in "$@"; do
    name=$(basename "$program")
    help=$("$program" --help)
    [[ $name != lumicut-play ]] || settings=$(sed -nE 's/^  ([a-z_.]+) = .*/\1/p' <<<"$help")
    for command in $(awk '/^Subcommands:/ { on = 1; next } on && NF { print $1 }' <<<"$help"); do
        help+=$'\n'$("$program" "$command" --help)
    done
    listed=$(grep -oE '^ +(-[a-z],)?--[a-z-]+' <<<"$help" | grep -oE -- '--[a-z-]+' | sort -u)
    [[ -n $listed ]] || complain "$name --help lists no options"
    for option in $listed; do
        options+="$option "
        [[ $option == --help || $option == --version || $cli == *"$option"[^a-z-]* ]] ||
            complain "docs/cli.md does not name $option of $name"
    done
done
for option in $(grep -oE -- '(^|[^a-z-])--[a-z][a-z-]+' docs/cli.md | grep -oE -- '--[a-z-]+' | sort -u); do
    [[ $options == *" $option "* ]] || complain "docs/cli.md names $option, which no program has"
done

# Settings are named by their group (photons.count), or after --set.
[[ -n $settings ]] || complain "lumicut-play --help lists no settings"
groups=$(grep -oE '^[a-z_]+\.' <<<"$settings" | sort -u | tr -d '.' | paste -sd '|')
named=$(grep -ohE "(--set |\`)(($groups)\.)?[a-z_]+[=\`]" README.md docs/*.md | sed -E 's/^(--set |`)//; s/[=`]$//' | grep -E "^($groups)\." || true)
named+=$'\n'$(grep -ohE -- "--set [a-z_.]+=" README.md docs/*.md | sed -E 's/^--set //; s/=$//' || true)
for setting in $(sort -u <<<"$named"); do
    [[ $setting =~ \.(cpp|h|comp|glsl|md)$ ]] || grep -qxF -- "$setting" <<<"$settings" ||
        complain "a document names the setting $setting, which does not exist"
done
exit $result
