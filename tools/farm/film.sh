#!/usr/bin/env bash
# Joins what a job of a farm has rendered: frames into a film (ffmpeg, H.264), samples into one picture (lumicut-compare merge).
#   tools/farm/film.sh FOLDER [FILE]     FILE: default that of --film
# Only once all are there and all were rendered from one package with one set of settings. Frames in .png are as the player shows
# them; of .exr the film has the plain sRGB curve, so that what is brighter than white is cut off.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"

[[ ${1-} != --help && $# -ge 1 ]] || { usage_of "$0" && exit 1; }
load_job "$1"
film=${2-$film}
[[ -n $film ]] || fail 1 "which file? (see --help)"
folder=${state%/.farm}

# Tasks that were sent to other machines have come later than this job: it goes to the end of the queue.
wait_for_others() {
    [[ -n ${SLURM_JOB_ID-} ]] || return 1
    squeue --noheader --name "$job_name" --format %i | grep -qvx "$SLURM_JOB_ID" || return 1
    lasting_options
    sbatch --parsable --job-name "$job_name" --dependency singleton --ntasks 1 --requeue --open-mode append \
        --output "$state/logs/film.log" --partition "$SLURM_JOB_PARTITION" "${lasting[@]}" \
        --wrap "exec $(printf '%q ' "$farm/film.sh" "$folder" "$film")" >/dev/null
}
incomplete() {
    if wait_for_others; then
        say "film: some tasks are still at work; joined after them"
        exit 0
    fi
    fail 2 "$1; the job's command renders them, then $farm/film.sh $folder joins"
}

temporary=${film%.*}.$$.tmp.${film##*.}
trap 'rm -f "$temporary"' EXIT
if [[ $kind == samples ]]; then
    find_program lumicut-compare
    parts=()
    for item in $(seq "$first" "$chunk" "$last"); do
        parts+=("$folder/$(printf "$pattern" "$item")")
        [[ -s ${parts[-1]} ]] || incomplete "the samples from $item on are missing"
    done
    "$lumicut_compare" merge "${parts[@]}" -o "$film" && say "film: $film of samples $first-$last"
    exit
fi
command -v ffmpeg >/dev/null || fail 1 "there is no ffmpeg here (Debian: ffmpeg)"
find_program lumicut-play
missing=$("$lumicut_play" "${command[@]:1}" --frames "$first-$last" --list-missing) || exit
[[ -z $missing ]] || incomplete "frames are missing: $(ranges <<<"$missing")"
curve=()
[[ $pattern != *.exr ]] || curve=(-apply_trc iec61966_2_1)
# Codecs want even sizes.
ffmpeg -nostdin -v error -y -framerate "${film_options[0]}" -start_number "$first" "${curve[@]}" -i "$folder/$pattern" \
    -frames:v $((last - first + 1)) -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2' -c:v libx264 -crf 18 -pix_fmt yuv420p "$temporary" &&
    mv "$temporary" "$film" || fail 2 "ffmpeg has failed; it said the above"
say "film: $film of frames $first-$last"
