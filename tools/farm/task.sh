#!/usr/bin/env bash
# One task of a farm: a chunk of frames, or of scenes. Sent by render.sh and compile.sh; may be run by hand and killed anywhere.
#   tools/farm/task.sh FOLDER [TASK [SLOT]]    FOLDER: of the results; TASK: default that of Slurm; SLOT: of this machine, from 1
# Exit codes are those of the program. What is worth another try is tried again, here or by Slurm elsewhere: code 75 (the device
# was lost, or its memory full), a program that a signal ended from outside, and under Slurm what another machine may have, a
# suitable device (code 4) or the share with the package (code 2). Tries that bring something do not count.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[[ ${1-} != --help && $# -ge 1 ]] || { usage_of "$0" && exit; }
task=${2-${SLURM_ARRAY_TASK_ID-}} slot=${3-1}
[[ $task =~ ^[0-9]+$ ]] || fail 1 "which task? (see --help)"
load_job "$1"
range_of "$task"
name=$kind-$from-$to
[[ -n ${LUMICUT_BIN-} ]] || export LUMICUT_BIN=$bin
bin=$LUMICUT_BIN
find_program "${command[0]}"
program=${command[0]//-/_}
in_slurm=${SLURM_JOB_ID:+1}
# Not SLURM_JOB_ID, which of one task is the number of the array.
job=${SLURM_ARRAY_JOB_ID-${SLURM_JOB_ID-}}${SLURM_ARRAY_TASK_ID:+_$SLURM_ARRAY_TASK_ID}
folder=${state%/.farm}
marker=$state/running/$from-$to
times=$state/times/$from-$to.$(uname -n)-$$ # when it began, and by the file's date when it was last alive
tries_file=$state/tries/$from-$to

# Of software devices, whose threads are not Slurm's business.
export LP_NUM_THREADS=$cores

# ---- Which device: Vulkan knows nothing of CUDA_VISIBLE_DEVICES ----------------------------------------------------

# choose_device: of the machine's GPUs, in the order of their list, the one that is this task's. Sets `device`, or returns 1.
choose_device() {
    device=()
    ((gpu)) || return 0
    local -a gpus
    mapfile -t gpus < <("${!program}" --list-devices 2>/dev/null | sed -nE '/\(cpu,/!s/^([0-9]+): .*/\1/p')
    local index=$((slot - 1)) granted=${SLURM_STEP_GPUS:-${SLURM_JOB_GPUS:-${CUDA_VISIBLE_DEVICES-}}}
    ((${#gpus[@]})) || return 1
    # Where the others are hidden from the task, there is one to see, whatever its number elsewhere.
    if ((${#gpus[@]} == 1)); then
        index=0
    elif [[ $granted =~ ^[0-9]+ ]]; then
        index=${BASH_REMATCH[0]}
    fi
    device=(--device "${gpus[index % ${#gpus[@]}]}")
}

# ---- Running ------------------------------------------------------------------------------------------------------

# beat: as long as this script lives, the marker is touched. It waits in a pipe to which nobody writes: Slurm would wait for a
# process sleep that is left, seconds at the end of each task.
beat() {
    local quiet
    exec {quiet}<> <(:)
    while kill -0 $$ 2>/dev/null; do
        read -rt "$heartbeat" -u "$quiet"
        touch "$marker" "$times" 2>/dev/null
    done
}

# Signals that reach this script are for the task as a whole: cancelled, or preempted (then Slurm starts it again itself).
ended=
child=
forward() {
    ended=$1
    [[ -z $child ]] || kill -TERM "$child" 2>/dev/null
}
trap 'forward 143' TERM
trap 'forward 130' INT
trap 'forward 129' HUP
trap 'rm -f "$marker"; kill $beating 2>/dev/null; touch "$times" 2>/dev/null' EXIT

run_once() {
    local -a run=("${!program}" "${command[@]:1}" "${device[@]}")
    local stats=$state/stats/$from-$to.$(uname -n)-$$-$SECONDS.json
    case $kind in
    frames) run+=(--frames "$from-$to" --stats "$stats") ;;
    samples) # of one picture, a file each
        run+=(--samples "$from-$to" --output "$folder/$(printf "$pattern" "$from")" --stats "$stats") ;;
    scenes) run+=(--jobs "$cores" -- "${scenes[@]:from:to - from + 1}") ;;
    esac
    # A step of its own: Slurm sends the signal before the time limit to steps.
    [[ -z $in_slurm ]] || run=(srun --ntasks 1 --cpus-per-task "$cores" --unbuffered --quiet "${run[@]}")
    "${run[@]}" &
    child=$!
    wait "$child"
    code=$?
    while kill -0 "$child" 2>/dev/null; do # a signal has ended the waiting, not the program
        wait "$child"
        code=$?
    done
    child=
}

# send_elsewhere: the same task again, on any machine but this one and those that the job was kept from already.
send_elsewhere() {
    local bad
    bad=$(squeue --noheader --jobs "$job" --format %x) || bad=
    [[ $bad != "(null)" ]] || bad=
    local -a batch=(sbatch --parsable --job-name "$job_name" --array "$task" --ntasks 1 --cpus-per-task "$cores" --requeue
        --signal TERM@60 --open-mode append --output "$state/logs/%a.log" --partition "$SLURM_JOB_PARTITION")
    ((gpu == 0)) || batch+=(--gres gpu:1)
    lasting_options
    "${batch[@]}" "${lasting[@]}" --exclude "${bad:+$bad,}$SLURMD_NODENAME" --wrap "exec $(printf '%q ' "$farm/task.sh" "$folder")"
}

: >"$marker" || { say "$name: error: $marker cannot be written; is the share there and not full?" && exit 2; }
echo "${SLURMD_NODENAME:-$(uname -n)} ${SLURM_JOB_ID:-$$}" >"$marker"
{ : >"$times" && stat -c %.3Y "$times" >"$times.begin" && mv "$times.begin" "$times"; } 2>/dev/null
beat &
beating=$!

# time_is_left: not where the signal came because the job's time is up. Slurm sends it up to a minute early.
time_is_left() {
    local end
    end=$(date -d "$(squeue --noheader --jobs "$job" --format %e)" +%s 2>/dev/null) || return 0 # it has no end
    ((end - $(date +%s) > 130))
}

# ---- Tries: only those that have brought nothing count, wherever they were made -------------------------------------

# count_done: sets `done_count`.
count_done() {
    local item file
    done_count=0
    for ((item = from; item <= to; item += step)); do
        file_of "$item"
        [[ ! -s $file ]] || ((++done_count))
    done
}
# read_tries: sets `attempt`, how many were made since something was done, and since the job was submitted.
read_tries() {
    attempt=0
    local before=-1
    [[ ! $tries_file -nt $state/job ]] || read -r attempt before <"$tries_file"
    count_done
    ((done_count <= before)) || attempt=0
}
note_try() {
    count_done
    attempt=$((done_count > had ? 0 : attempt + 1))
    { echo "$attempt $done_count" >"$tries_file.new" && mv "$tries_file.new" "$tries_file"; } 2>/dev/null
}

scenes=()
[[ $kind != scenes ]] || mapfile -t scenes <"$list_file"
# Here at first, as being put back takes minutes under Slurm; a machine that has failed twice may be the cause.
here=2
read_tries
while :; do
    had=$done_count
    say "$name: begins (try $((attempt + 1)) of $tries)"
    if choose_device; then
        run_once
    else
        echo "$(basename "${!program}"): error: no GPU can be used here (--list-devices); is the driver installed?" >&2
        code=4
    fi
    if ((code == 0)); then
        say "$name: done"
        exit 0
    fi
    if [[ -n $ended ]]; then
        say "$name: ended from outside; what is written is whole, and the same job goes on with the rest"
        exit "$ended"
    fi
    lack=
    ((code != 4)) || lack="no suitable device"
    # A whole farm would run into a machine that fails at once, as it is always idle.
    ((code != 2)) || [[ $kind == scenes || -r ${command[1]} ]] || lack="no readable ${command[1]}"
    if [[ -n $lack && -n $in_slurm ]] && other=$(send_elsewhere); then
        say "$name: $lack on this machine (exit code $code); job ${other%%;*} tries elsewhere"
        exit "$code"
    fi
    if ((code != 75 && code < 128)); then
        say "$name: failed with exit code $code; another try is of no use before the cause above is gone"
        exit "$code"
    fi
    note_try
    if ((attempt >= tries)); then
        say "$name: failed with exit code $code in the last of $tries tries"
        exit "$code"
    fi
    time_up=
    [[ -z $in_slurm ]] || time_is_left || time_up=1
    say "$name: ${time_up:+its time is up: }ended with exit code $code, and is tried again"
    if [[ -n $in_slurm ]] && { ((--here == 0)) || [[ -n $time_up ]]; }; then
        rm -f "$marker"
        scontrol requeue "$job" && sleep 60 # ends this script
        exit "$code"
    fi
    sleep 1
done
