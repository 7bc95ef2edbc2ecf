#!/usr/bin/env bash
# Renders a sequence, or the samples of one reference, on many machines: an array of Slurm, or without an engine on this one.
#   tools/farm/render.sh PACKAGE --frames A-B --output DIR/frame-%05d.exr [OPTION...] [OPTION OF lumicut-play...]
#   tools/farm/render.sh PACKAGE --samples A-B --output DIR/part-%06d.exr --mode reference [...]
#   tools/farm/render.sh --status DIR        what is done, running and missing, from the folder alone
#     --chunk N          frames or samples a task; default that of --part, or 64. Multiples of that do no work twice
#     --part N           of lumicut-play: frames of mode gi that go on from each other; longer ones throw away less
#     --cores N          CPU cores a task; default 1
#     --gpu              a GPU for each task (--gres gpu:1 of Slurm)
#     --film FILE.mp4    joins the frames with ffmpeg once all are there; of samples --film FILE.exr: adds them up
#     --dependency JOB   begins after this job of Slurm, such as that of compile.sh, has succeeded
#     --sbatch OPTION    for sbatch, such as --sbatch=--partition=gpu; may be repeated
#     --tries N          how often in succession a task may fail without having brought anything; default 10
#     --local            without Slurm: GNU parallel on this machine
#     --workers N        of --local: tasks at a time; default one for each --cores cores
#     --dry-run          prints what would be submitted
# The folder of --output must be there, and every machine must see it, the package and these scripts under the same names.
# The same command goes on after any failure: frames that are there and whole stay. docs/farm.md has the rest.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

chunk= cores=1 gpu=0 tries=10 here=0 dry_run=0 workers= dependency= status= frames= samples= output= film=
extra=() player=() operands=()
while (($#)); do
    value=${2-}
    if [[ $1 == --*=* ]]; then # --option=value
        set -- "${1%%=*}" "${1#*=}" "${@:2}"
        value=$2
    fi
    case $1 in
    --help | -h) usage_of "$0" && exit ;;
    --gpu) gpu=1 ;;
    --local) here=1 ;;
    --dry-run) dry_run=1 ;;
    --chunk | --cores | --tries | --workers | --dependency | --status | --frames | --samples | --output | --film)
        (($# >= 2)) || fail 1 "$1 needs a value (see --help)"
        declare "${1#--}=$value" && shift ;;
    --sbatch) extra+=("$value") && shift ;;
    --path | --fps | --part | --mode | --preset | --camera | --animation | --time | --seed | --device | --set | --size | --spp | --layers | --view | --against)
        (($# >= 2)) || fail 1 "$1 needs a value (see --help)"
        player+=("$1" "$value") && shift ;;
    --force) fail 1 "--force would render every frame again with each try; empty the folder instead" ;;
    -*) fail 1 "unknown option $1 (see --help)" ;;
    *) operands+=("$1") ;;
    esac
    shift
done
for number in ${chunk:+chunk} cores tries ${workers:+workers}; do
    [[ ${!number} =~ ^[1-9][0-9]{0,6}$ ]] || fail 1 "--$number ${!number}: a number from 1 on is expected"
done
if [[ -n $status ]]; then
    exec "$farm/status.sh" "$status"
fi
((${#operands[@]} == 1)) || fail 1 "one package is expected (see --help)"
package=${operands[0]}
[[ -n $output ]] || fail 1 "--output DIR/frame-%05d.exr is needed (see --help)"
[[ -n $frames || -n $samples ]] && [[ -z $frames || -z $samples ]] || fail 1 "either --frames A-B or --samples A-B is needed"
[[ $frames$samples =~ ^([0-9]{1,7})-([0-9]{1,7})$ ]] || fail 1 "'$frames$samples' is no range such as 0-239"
first=$((10#${BASH_REMATCH[1]})) last=$((10#${BASH_REMATCH[2]}))
((first <= last)) || fail 1 "the last of $frames$samples comes before the first"
[[ $(basename "$output") =~ ^[^%]*%(0[1-9])?d[^%]*$ ]] || fail 1 "--output $output: the name has one %d or %0Nd for the number"
output=$(absolute "$output")
pattern=$(basename "$output")
[[ -n $dependency || -r $package ]] || fail 2 "the package $package cannot be read"
# A package that a job is still to make may lie in a folder that is not there yet.
[[ $package == /* ]] || package=$PWD/$package
[[ -z $film ]] || film=$(absolute "$film")
find_program lumicut-play
part=64 mode=gi spp= film_options=(30)
for ((i = 0; i < ${#player[@]}; i += 2)); do # of other machines' current folders
    case ${player[i]} in
    --path | --against) player[i + 1]=$(absolute "${player[i + 1]}") ;;
    --device) ((gpu == 0)) || fail 1 "--gpu and --device both say which device; give one" ;;
    --fps) film_options=("${player[i + 1]}") ;;
    --part) part=${player[i + 1]} ;;
    --mode) mode=${player[i + 1]} ;;
    --spp) spp=${player[i + 1]} ;;
    esac
done

[[ $part =~ ^[1-9][0-9]{0,6}$ ]] || fail 1 "--part $part: a number from 1 on is expected"
: "${chunk:=$part}"

kind=frames
command=(lumicut-play "$package" --headless "${player[@]}" --output "$output")
if [[ -n $samples ]]; then
    kind=samples
    command=(lumicut-play "$package" --headless "${player[@]}")
fi
# Frames of mode gi go on from earlier ones, but for --spp.
if [[ $kind == frames && -z $spp && $mode == gi ]] && ((last - first >= chunk && (chunk % part != 0 || first % part != 0))); then
    echo "note: chunks of $chunk frames from $first on begin within parts of $part frames, so that tasks render frames that they throw away" >&2
fi
list_file=
state=$(dirname "$output")/.farm
job_name=lumicut-$(cksum <<<"$output" | cut -d ' ' -f 1)
((dry_run)) || keep_job
: "${workers:=$((($(nproc) + cores - 1) / cores))}"

job=
submit "$(task_count)" ${dependency:+--dependency "afterok:$dependency" --kill-on-invalid-dep=yes} "${extra[@]}"
[[ -z $job ]] || echo "$job"
[[ -n $film ]] || exit 0
if ((here)); then
    echo "$farm/film.sh $(dirname "$output")"
    ((dry_run)) || exec "$farm/film.sh" "$(dirname "$output")"
    exit 0
fi
# Not only after the array: tasks that a machine could not do are sent elsewhere as jobs of the same name.
lasting_options
batch=(sbatch --parsable --job-name "$job_name" --dependency singleton --ntasks 1 --requeue --open-mode append
    --output "$state/logs/film.log" "${lasting[@]}" --wrap "exec $(printf '%q ' "$farm/film.sh" "$(dirname "$output")")")
printf '%q ' "${batch[@]}"
echo
((dry_run)) || "${batch[@]}"
