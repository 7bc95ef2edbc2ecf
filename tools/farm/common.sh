# What the scripts of a farm share. Sourced, never run. Everything that they keep lies in a folder .farm beside the results, so
# that any machine that sees the results sees what is to be done, what is being done and how it went.

. "$(dirname "${BASH_SOURCE[0]}")/../bench/options.sh"

farm=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=${LUMICUT_BIN:-}

# A marker of a running task is touched every heartbeat seconds; an older one than stale seconds is of a task that died.
heartbeat=10 stale=60

# find_program NAME: sets the variable of that name, dashes as underscores: from LUMICUT_BIN, else from PATH, else from a build
# beside the scripts.
find_program() {
    local -n program=${1//-/_}
    local built
    built=$(dirname "$(dirname "$farm")")/build/release/bin/$1
    if [[ -n $bin ]]; then
        program=$bin/$1
    else
        program=$(command -v "$1" || echo "$built")
    fi
    [[ -x $program ]] || fail 1 "there is no $1 in PATH; install it, or name its folder in LUMICUT_BIN"
}

# say TEXT: a line of a task's log, with when and where.
say() {
    echo "$(date '+%F %T') ${SLURMD_NODENAME:-$(uname -n)}: $*" >&2
}

# absolute PATH: the same file, from anywhere; its folder must be there.
absolute() {
    local folder
    folder=$(cd "$(dirname "$1")" 2>/dev/null && pwd) || fail 2 "there is no folder $(dirname "$1")"
    echo "${folder%/}/$(basename "$1")"
}

# seconds_since FILE: how long ago it was changed, by the clock of the share that holds it. Clocks of machines may differ.
seconds_since() {
    local probe now then
    probe=$(mktemp "$state/clock.XXXXXX") || return 1
    now=$(stat -c %Y "$probe")
    rm -f "$probe"
    then=$(stat -c %Y "$1" 2>/dev/null) || return 1
    echo $((now - then))
}

# keep_job: writes what tasks need. Wants `state`, the folder .farm, and the variables below.
keep_job() {
    mkdir -p "$state"/{running,logs,stats,times,tries} || fail 2 "the folder $state cannot be made"
    local text
    text=$(declare -p kind command first last chunk pattern list_file gpu cores tries film film_options extra bin job_name) || exit
    echo "$text" >"$state/job.$$" && mv "$state/job.$$" "$state/job" || fail 2 "$state/job cannot be written"
}

# load_job FOLDER: the other way round, and `step` from one item with a file of its own to the next.
load_job() {
    state=$1/.farm
    [[ -r $state/job ]] || fail 2 "there is no job in $1 (no readable $state/job); was it submitted, and is the share there?"
    # declare makes variables of functions local.
    . <(sed 's/^declare /declare -g /' "$state/job")
    step=1
    [[ $kind != samples ]] || step=$chunk
}

# range_of TASK: sets from and to, the first and the last item of a task; the last task is shorter.
range_of() {
    from=$((first + $1 * chunk))
    to=$((from + chunk - 1))
    ((to <= last)) || to=$last
    ((from <= last)) || fail 1 "there is no task $1"
}

# file_of ITEM: sets `file` to that of a frame, of a part or of a scene's package. Wants `folder`, and of scenes the array `scenes`.
file_of() {
    if [[ $kind == scenes ]]; then
        file=${scenes[$1]##*/}
        file=$folder/${file%.*}.lumi
    else
        printf -v file "%s/$pattern" "$folder" "$1"
    fi
}

task_count() {
    echo $(((last - first) / chunk + 1))
}

# missing_ranges NUMBER...: "3-5 9", of ascending numbers.
ranges() {
    awk '{ if (NR > 1 && $1 == end + 1) end = $1
           else { if (NR > 1) print (start == end ? start : start "-" end); start = end = $1 } }
         END { if (NR) print (start == end ? start : start "-" end) }' | paste -sd ' '
}

# running_tasks: a line for each task whose marker is fresh: "A-B HOST SECONDS".
running_tasks() {
    local marker age
    for marker in "$state"/running/*; do
        [[ -e $marker ]] || continue
        age=$(seconds_since "$marker") || continue
        ((age <= stale)) && echo "$(basename "$marker") $(<"$marker")"
    done
}

# lasting_options: sets `lasting` to those of the user's options for sbatch that hold for jobs sent later, too. By then what they
# depend on has ended, and may be unknown.
lasting_options() {
    lasting=()
    local option skip=0
    for option in "${extra[@]}"; do
        case $option in
        --dependency | -d) skip=1 ;;
        --dependency=* | -d* | --kill-on-invalid-dep=*) skip=0 ;;
        *) ((skip)) || lasting+=("$option")
            skip=0 ;;
        esac
    done
}

# submit TASKS OPTION...: sends the array to Slurm, or runs it here. Wants the variables of keep_job, and dry_run, here, workers.
submit() {
    local tasks=$1 last_task=$(($1 - 1)) folder=${state%/.farm}
    shift
    if ((here)); then
        local -a run=(parallel --will-cite --jobs "$workers" --line-buffer --termseq 'TERM,6000,KILL'
            "$farm/task.sh" "$(printf %q "$folder")" '{}' '{%}' ::: $(seq 0 "$last_task"))
        echo "${run[*]}"
        ((dry_run)) && return
        command -v parallel >/dev/null || fail 1 "--local needs GNU parallel (Debian: parallel)"
        "${run[@]}"
        return
    fi
    local -a batch=(sbatch --parsable --job-name "$job_name" --array "0-$last_task" --ntasks 1 --cpus-per-task "$cores"
        --requeue --signal TERM@60 --open-mode append --output "$state/logs/%a.log")
    ((gpu == 0)) || batch+=(--gres gpu:1)
    batch+=("$@" --wrap "exec $(printf '%q ' "$farm/task.sh" "$folder")")
    printf '%q ' "${batch[@]}"
    echo
    ((dry_run)) && return
    command -v sbatch >/dev/null || fail 1 "there is no sbatch here; --local runs the tasks without Slurm"
    job=$("${batch[@]}") || fail 2 "Slurm has not taken the job; it said the above"
    job=${job%%;*}
}
