#!/usr/bin/env bash
# What is done, running and missing of a job of a farm, from the folder of its results alone: no engine and no program is asked.
#   tools/farm/status.sh FOLDER
# Below that: what the time of the workers went into, by the clock of the share.
# Results appear under their names when they are whole, so that a name suffices. A running task touches a marker; one that has
# not been touched for a minute is of a task that died. Exit code 0: all are done, 1: some are missing.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[[ ${1-} != --help && $# -eq 1 ]] || { usage_of "$0" && exit 1; }
load_job "$1"
folder=${state%/.farm}

scenes=()
[[ $kind != scenes ]] || mapfile -t scenes <"$list_file"

done_count=0 missing=() new_count=0
for ((item = first; item <= last; item += step)); do
    file_of "$item"
    if [[ -s $file ]]; then
        ((++done_count))
        [[ ! $file -nt $state/job ]] || ((++new_count))
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

# ---- What the workers' time went into, since the job was last submitted ----------------------------------------------

# Workers: the most tasks at a time. Each has its cores for as long as the job lasts, from its first task's begin to its last one's end.
# of_tasks: a line for each time that a task began: its begin and end, seconds. Clocks are the share's.
of_tasks() {
    local times
    find "$state/times" -type f -newer "$state/job" | while read -r times; do
        echo "$(<"$times") $(stat -c %.3Y "$times")"
    done | awk 'NF == 2'
}
# of_programs: members of the reports of programs that ended in order; frames of a killed one take what others take.
of_programs() {
    find "$state/stats" -name '*.json' -newer "$state/job" -exec cat {} + |
        awk -F '[":, ]+' '/"(frames_written|frames_ms|thrown_away_ms|elapsed_ms)"/ { print $2, $3 }'
}
{ of_tasks | sort -n && of_programs; } 2>/dev/null | awk -v count="$new_count" -v cores="$cores" -v kind="$kind" '
    $1 ~ /^[0-9.]+$/ {
        for (i = 1; i <= NR - 1; ++i) running += ends[i] > $1
        if (++running > workers) workers = running
        running = 0
        if (NR == 1) begin = $1
        ends[NR] = $2
        if ($2 > end) end = $2
        tasks += $2 - $1
    }
    { sums[$1] += $2 }
    function share(seconds, words) { printf "         %5.1f %%  %s\n", 100 * seconds / all, words }
    END {
        all = workers * (end - begin)
        if (all <= 0) exit
        printf "time     %.0f s of %d worker%s with %d core%s\n", end - begin, workers, (workers > 1 ? "s" : ""), cores, (cores > 1 ? "s" : "")
        if (kind == "scenes" || !sums["frames_written"]) {
            share(tasks, "tasks")
        } else {
            kept = sums["frames_ms"] / sums["frames_written"] * count / 1000
            thrown = sums["thrown_away_ms"] / 1000
            starts = (sums["elapsed_ms"] - sums["frames_ms"] - sums["thrown_away_ms"]) / 1000
            if (kind == "frames") printf "         %.2f s a frame, %.0f frames an hour\n", kept / count, 3600 * count / (end - begin)
            share(kept, kind " that are kept")
            if (kind == "frames") share(thrown, "frames that are not kept")
            share(starts, "starts of programs")
            share(tasks - kept - thrown - starts, "programs that were killed or still run, and tasks around programs")
        }
        share(all - tasks, "between tasks: waiting for one, and idle at the end")
    }'
((${#missing[@]} == 0))
