#!/usr/bin/env bash
# Compiles many scenes on many machines: an array of Slurm, or without an engine on this one.
#   tools/farm/compile.sh LIST OUTDIR [OPTION...] [-- OPTION OF lumicut-compile...]
#   tools/farm/compile.sh --status OUTDIR    what is done, running and missing, from the folder alone
#     LIST: a file with a scene (.gltf, .glb) in each line; lines that begin with # are left out
#     --chunk N          scenes a task; default 4
#     --cache FOLDER     shared by all tasks; default OUTDIR/.farm/cache
#     --cores N          CPU cores a task; default 1
#     --dependency JOB, --sbatch OPTION, --tries N, --local, --workers N, --dry-run: as of render.sh
# Prints the job's number in its last line, for --dependency of render.sh. Packages that are up to date stay.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

chunk=4 cores=1 gpu=0 tries=10 local=0 dry_run=0 workers= dependency= status= cache=
extra=() options=() film= film_options=() pattern=
arguments=()
while (($#)) && [[ $1 != -- ]]; do
    arguments+=("$1")
    shift
done
(($# == 0)) || options=("${@:2}")
read_options chunk= cores= tries= workers= dependency= status= cache= sbatch+=extra dry-run local -- "${arguments[@]}"
here=$local
for number in chunk cores tries ${workers:+workers}; do
    [[ ${!number} =~ ^[1-9][0-9]{0,6}$ ]] || fail 1 "--$number ${!number}: a number from 1 on is expected"
done
if [[ -n $status ]]; then
    exec "$farm/status.sh" "$status"
fi
((${#operands[@]} == 2)) || fail 1 "a list of scenes and a folder for the packages are expected (see --help)"
[[ -r ${operands[0]} ]] || fail 2 "the list ${operands[0]} cannot be read"
folder=$(absolute "${operands[1]%/}")
find_program lumicut-compile
scenes=()
declare -A taken=()
while IFS= read -r scene || [[ -n $scene ]]; do
    [[ -n $scene && $scene != "#"* ]] || continue
    [[ $scene == /* ]] || scene=$PWD/$scene
    [[ -r $scene ]] || fail 2 "the scene $scene of ${operands[0]} cannot be read"
    name=$(basename "$scene")
    name=${name%.*}.lumi
    [[ -z ${taken[$name]-} ]] || fail 1 "$scene and ${taken[$name]} would have the same package, $folder/$name"
    taken[$name]=$scene
    scenes+=("$scene")
done <"${operands[0]}"
((${#scenes[@]})) || fail 1 "there is no scene in ${operands[0]}"

kind=scenes first=0 last=$((${#scenes[@]} - 1))
state=$folder/.farm
list_file=$state/scenes
command=(lumicut-compile "${options[@]}" --output "$folder/" --cache "${cache:-$state/cache}")
job_name=lumicut-$(cksum <<<"$folder" | cut -d ' ' -f 1)
: "${workers:=$((($(nproc) + cores - 1) / cores))}"
if ((!dry_run)); then
    mkdir -p "$folder"
    keep_job
    printf '%s\n' "${scenes[@]}" >"$list_file"
fi
job=
submit "$(task_count)" ${dependency:+--dependency "afterok:$dependency" --kill-on-invalid-dep=yes} "${extra[@]}"
[[ -z $job ]] || echo "$job"
