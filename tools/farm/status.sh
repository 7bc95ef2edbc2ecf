#!/usr/bin/env bash
# What is done, running and missing of a job of a farm, from the folder of its results alone: no engine and no program is asked.
#   tools/farm/status.sh FOLDER
# Results appear under their names when they are whole, so that a name suffices. A running task touches a marker; one that has
# not been touched for a minute is of a task that died. Exit code 0: all are done, 1: some are missing.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[[ ${1-} != --help && $# -eq 1 ]] || { usage_of "$0" && exit 1; }
load_job "$1"
folder=${state%/.farm}

# name_of ITEM: the file of a frame, of a part or of a scene's package.
items() {
    if [[ $kind == samples ]]; then
        seq "$first" "$chunk" "$last"
    else
        seq "$first" "$last"
    fi
}
name_of() {
    if [[ $kind == scenes ]]; then
        local scene
        scene=$(basename "${scenes[$1]}")
        echo "$folder/${scene%.*}.lumi"
    else
        printf "%s/$pattern\n" "$folder" "$1"
    fi
}
scenes=()
[[ $kind != scenes ]] || mapfile -t scenes <"$list_file"

done_count=0 missing=()
for item in $(items); do
    if [[ -s $(name_of "$item") ]]; then
        ((++done_count))
    else
        missing+=("$item")
    fi
done
running=$(running_tasks)

# in_running ITEM: whether a running task is to make it.
in_running() {
    local task range
    while read -r range _; do
        [[ -n $range ]] && ((${range%-*} <= $1 && $1 <= ${range#*-})) && return 0
    done <<<"$running"
    return 1
}
waiting=() busy=()
for item in "${missing[@]}"; do
    if in_running "$item"; then busy+=("$item"); else waiting+=("$item"); fi
done
what=$kind
[[ $kind != samples ]] || what="parts of samples"
echo "done     $done_count of $((done_count + ${#missing[@]})) $what"
echo "running  ${#busy[@]}${busy[*]:+: $(printf '%s\n' "${busy[@]}" | ranges)}"
while read -r range where; do
    [[ -z $range ]] || echo "         task $range on ${where% *} (${where##* })"
done <<<"$running"
echo "missing  ${#waiting[@]}${waiting[*]:+: $(printf '%s\n' "${waiting[@]}" | ranges)}"

# What the tasks' time went into, of those that ended in order.
if compgen -G "$state/stats/*.json" >/dev/null; then
    cat "$state"/stats/*.json | awk -v FS='[:,]' '
        /"frames_written"/ { frames += $2 }
        /"frames_ms"/ { kept += $2 }
        /"thrown_away_ms"/ { thrown += $2 }
        /"elapsed_ms"/ { elapsed += $2; ++tasks }
        END { if (elapsed > 0 && frames > 0)
            printf "time     %.1f s a frame and worker, %.0f frames an hour for each; %.1f %% of it for frames, %.1f %% for frames that are not kept, %.1f %% for starts\n",
                elapsed / frames / 1000, frames / elapsed * 3600000, 100 * kept / elapsed, 100 * thrown / elapsed,
                100 - 100 * (kept + thrown) / elapsed }'
fi
((${#missing[@]} == 0))
