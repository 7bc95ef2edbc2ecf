#!/usr/bin/env bash
# One task of a farm: a chunk of frames, or of scenes. Sent by render.sh and compile.sh; may be run by hand and killed anywhere.
#   tools/farm/task.sh FOLDER [TASK [SLOT]]    FOLDER: of the results; TASK: default that of Slurm; SLOT: of this machine, from 1
# Exit codes are those of the program. What is worth another try is tried again, here or by Slurm elsewhere: code 75 (the device
# was lost, or its memory full), a program that a signal ended from outside, and under Slurm code 4 on another machine.
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
restarts=${SLURM_RESTART_COUNT:-0}
folder=${state%/.farm}
marker=$state/running/$from-$to

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

# beat: as long as this script lives, the marker is touched.
beat() {
    while sleep "$heartbeat" && kill -0 $$ 2>/dev/null; do
        touch "$marker" 2>/dev/null
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
trap 'rm -f "$marker"; kill $beating 2>/dev/null' EXIT

run_once() {
    local -a run=("${!program}" "${command[@]:1}" "${device[@]}")
    case $kind in
    frames) run+=(--frames "$from-$to" --stats "$state/stats/$from-$to.$(uname -n)-$$-$attempt.json") ;;
    samples) # of one picture, a file each
        run+=(--samples "$from-$to" --output "$folder/$(printf "$pattern" "$from")") ;;
    scenes)
        local -a scenes
        mapfile -t scenes < <(sed -n "$((from + 1)),$((to + 1))p" "$list_file")
        run+=(--jobs "$cores" -- "${scenes[@]}") ;;
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

# send_elsewhere: the same task again, on any machine but this one.
send_elsewhere() {
    local bad=${LUMICUT_FARM_EXCLUDED:+$LUMICUT_FARM_EXCLUDED,}$SLURMD_NODENAME
    local -a batch=(sbatch --parsable --job-name "$job_name" --array "$task" --ntasks 1 --cpus-per-task "$cores" --requeue
        --signal TERM@60 --open-mode append --output "$state/logs/%a.log" --exclude "$bad" --partition "$SLURM_JOB_PARTITION"
        --export "ALL,LUMICUT_FARM_EXCLUDED=$bad")
    ((gpu == 0)) || batch+=(--gres gpu:1)
    "${batch[@]}" --wrap "exec $(printf '%q ' "$farm/task.sh" "$folder")"
}

: >"$marker" || { say "$name: error: $marker cannot be written; is the share there and not full?" && exit 2; }
echo "${SLURMD_NODENAME:-$(uname -n)} ${SLURM_JOB_ID:-$$}" >"$marker"
beat &
beating=$!

# time_is_left: not where the signal came because the job's time is up.
time_is_left() {
    local end
    end=$(date -d "$(squeue --noheader --jobs "$SLURM_JOB_ID" --format %e)" +%s 2>/dev/null) || return 0 # it has no end
    ((end - $(date +%s) > 120))
}

# Here at first, as being put back takes minutes under Slurm; a machine that has failed twice may be the cause.
here=2
attempt=$((restarts * here))
while :; do
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
    if ((code == 4)) && [[ -n $in_slurm ]] && ((attempt + 1 < tries)); then
        if other=$(send_elsewhere); then
            say "$name: no suitable device on this machine (exit code 4); job ${other%%;*} tries elsewhere"
            exit 4
        fi
    fi
    if ((code != 75 && code < 128)); then
        say "$name: failed with exit code $code; another try is of no use before the cause above is gone"
        exit "$code"
    fi
    if ((++attempt >= tries)); then
        say "$name: failed with exit code $code in the last of $tries tries"
        exit "$code"
    fi
    say "$name: ended with exit code $code, and is tried again"
    if [[ -n $in_slurm ]] && { ((--here == 0)) || ! time_is_left; }; then
        rm -f "$marker"
        # Not by SLURM_JOB_ID, which of one task is the number of the array.
        scontrol requeue "${SLURM_ARRAY_JOB_ID-$SLURM_JOB_ID}${SLURM_ARRAY_TASK_ID:+_$SLURM_ARRAY_TASK_ID}" && sleep 60 # ends this script
        exit "$code"
    fi
    sleep 1
done
