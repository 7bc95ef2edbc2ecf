#!/usr/bin/env bash
# Tries the farm out on this machine: starts a cluster of Slurm with nodes of one core, compiles scenes and renders an animated
# one there, kills tasks at random, and compares every byte with what one process makes.
#   tools/farm/trial.sh [OPTION...]
#     --frames N      of the sequence; default 240
#     --scenes N      to compile, up to 12; default 12
#     --chunk N       frames a task; default --part
#     --part N        frames of mode gi that go on from each other; default 64
#     --kills N       how many tasks are killed: the program by TERM or KILL, or the task put back by Slurm; default 10
#     --pause S       seconds between them; default 15
#     --limit MIN     minutes after which Slurm ends a task, which it puts back a minute before; default: no limit
#     --nodes N       default 2
#     --bad-node      the last node has no Vulkan driver
#     --size WxH      of the frames; default 64x48
#     --mode MODE     of lumicut-play; default gi
#     --spp N         each frame is a picture of its own of N samples
#     --set NAME=VALUE    a setting; may be repeated
#     --sbatch OPTION     for sbatch; may be repeated
#     --seed N        of the choice of what is killed; default 1
#     --no-compare    renders nothing a second time, to measure alone
#     --keep FOLDER   works there and keeps everything
# LUMICUT_BIN=FOLDER uses the programs there. Exit code 0: all is equal; 1: it is not; 77: Slurm is not installed.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
. "$farm/slurm_here.sh"

frames=240 scenes=12 chunk= part=64 kills=10 pause=15 limit= nodes=2 bad_node= no_compare= size=64x48 mode=gi seed=1 keep= look=() farming=()
read_options frames= scenes= chunk= part= kills= pause= limit= nodes= bad-node no-compare size= mode= spp++=look set++=look seed= keep= \
    sbatch++=farming -- "$@"
: "${chunk:=$part}"
find_program lumicut-play
find_program lumicut-compile
find_program lumicut-scenes
work=${keep:-$(mktemp -d)}
mkdir -p "$work"
work=$(cd "$work" && pwd)
finish() {
    [[ -z ${killer-} ]] || kill "$killer" 2>/dev/null || true
    stop_slurm
    sleep 1
    [[ -n $keep ]] || rm -rf "$work"
}
trap finish EXIT
trap 'exit 143' TERM INT HUP

start_slurm "$work/slurm" "$nodes" || exit $(($? == 1 ? 77 : 1))
export XDG_CACHE_HOME=${XDG_CACHE_HOME:-$work/cache} # pipelines
export LUMICUT_BIN=$(dirname "$lumicut_play")
mkdir -p "$work/scenes" "$work/farm" "$work/one"
if [[ -n $bad_node ]]; then
    mkdir -p "$work/bin"
    for program in lumicut-compile lumicut-compare; do ln -sf "$LUMICUT_BIN/$program" "$work/bin/"; done
    printf '#!/bin/sh\n[ "$SLURMD_NODENAME" != n%s ] || export VK_DRIVER_FILES=/none VK_ICD_FILENAMES=/none\nexec "%s" "$@"\n' \
        "$nodes" "$LUMICUT_BIN/lumicut-play" >"$work/bin/lumicut-play"
    chmod +x "$work/bin/lumicut-play"
    export LUMICUT_BIN=$work/bin
fi

names=(lamp cornell caustics door walker ball shield sheets small slot bright80 neighbours)
((scenes <= ${#names[@]})) || fail 1 "--scenes $scenes: at most ${#names[@]}"
names=("${names[@]:0:scenes}")
"$lumicut_scenes" "$work/scenes" "${names[@]}" >/dev/null
printf "$work/scenes/%s.glb\n" "${names[@]}" >"$work/list"
look+=(--size "$size" --mode "$mode" --fps 24 --part "$part" --preset preview)
[[ -z $limit ]] || farming+=(--sbatch "--time=$limit")

start=$(date +%s.%N)
compile_job=$("$farm/compile.sh" "$work/list" "$work/farm/packages" --chunk 2 -- --quiet | tail -n 1)
render_job=$("$farm/render.sh" "$work/farm/packages/lamp.lumi" --frames "0-$((frames - 1))" --chunk "$chunk" \
    --output "$work/farm/f%05d.exr" --film "$work/film.mp4" --dependency "$compile_job" "${farming[@]}" "${look[@]}" | sed -n 2p)

# Processes of this trial only: their command lines name its folder.
random() { RANDOM_STATE=$(((RANDOM_STATE * 1103515245 + 12345) % 2147483648)) && drawn=$((RANDOM_STATE / 65536 % $1)); }
RANDOM_STATE=$seed
kill_one() {
    local -a pids jobs
    random 3
    if ((drawn == 2)); then
        mapfile -t jobs < <(squeue --noheader --states RUNNING --jobs "$render_job" --format %F_%K)
        ((${#jobs[@]})) || return 1
        random ${#jobs[@]}
        scontrol requeue "${jobs[drawn]}" 2>/dev/null && echo "put back job ${jobs[drawn]}"
        return
    fi
    local signal=TERM
    ((drawn == 0)) || signal=KILL
    mapfile -t pids < <(pgrep -x lumicut-play -a | grep -F -- "--output $work/farm/" | cut -d ' ' -f 1)
    ((${#pids[@]})) || return 1
    random ${#pids[@]}
    kill -$signal "${pids[drawn]}" 2>/dev/null && echo "$signal for process ${pids[drawn]}"
}
(
    for ((killed = 0; killed < kills;)); do
        sleep "$pause"
        kill_one && ((++killed))
    done
) >"$work/kills" &
killer=$!

while [[ -n $(squeue --noheader 2>/dev/null) ]]; do
    sleep 1
done
seconds=$(awk -v a="$start" -v b="$(date +%s.%N)" 'BEGIN { printf "%.0f", b - a }')
kill "$killer" 2>/dev/null || true
killer=

echo "cluster  $nodes nodes of one core${bad_node:+, the last without a driver}; $scenes scenes, $frames frames in chunks of $chunk: $seconds s, with $(wc -l <"$work/kills") kills"
"$farm/status.sh" "$work/farm" || { tail -n 20 "$work"/farm/.farm/logs/*.log >&2 && exit 1; }
echo "tries    $(cat "$work"/farm/.farm/logs/[0-9]*.log | grep -c ': begins') of $(((frames - 1) / chunk + 1)) tasks"

[[ -z $no_compare ]] || exit 0

# ---- The same by one process ---------------------------------------------------------------------------------------

unset LP_NUM_THREADS
"$lumicut_compile" --quiet --output "$work/one/" $(<"$work/list") >/dev/null
"$lumicut_play" "$work/one/lamp.lumi" --headless --frames "0-$((frames - 1))" --output "$work/one/f%05d.exr" "${look[@]}" 2>"$work/one.log"
result=0
compare() {
    local file equal=0 all=0
    for file in "$work"/one/*."$1"; do
        ((++all))
        cmp -s "$file" "$2/$(basename "$file")" && ((++equal)) || echo "differs: $(basename "$file")"
    done
    echo "equal    $equal of $all $3, byte by byte"
    ((equal == all)) || result=1
}
compare lumi "$work/farm/packages" packages
compare exr "$work/farm" frames
leftovers=$(find "$work/farm" -maxdepth 1 -name '*.tmp' | wc -l)
echo "left     $leftovers files that KILL has cut short, none under a frame's name"
if [[ -s $work/film.mp4 ]]; then
    echo "film     $(ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0 "$work/film.mp4") frames"
else
    echo "film     none" && result=1
fi
exit $result
