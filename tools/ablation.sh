#!/usr/bin/env bash
# The effect of each part of mode gi: error of the first frame and GPU milliseconds side by side, one setting changed at a
# time; then the illumination cut's lookups against full kNN and path tracing: with these settings, and like against like,
# with the photons of the method (100 an estimate) and without the cut's coverage correction at edges, which kNN does not have
# (cut.probes=0).
#   tools/ablation.sh [OPTION...] [OUTDIR]    OUTDIR: packages and references; default build/truth
#     --quick            small pictures, references of 256 samples, small counts
#     --scene NAME       of tools/bench/scenes.sh; default atrium
#     --size WxH         default 320x180
#     --spp N            samples a pixel of the reference; default 4096
#     --seeds N          first frames to average over; default 4
#     --travel N         frames of a moving camera before the rows about reuse; default 60
#     --set NAME=VALUE   a setting of all rows; repeatable
#     --row "NAME=VALUE..."   one more row; repeatable
# The reference's own noise is part of every error. LUMICUT_BIN=FOLDER uses the programs there instead of building.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

quick=0 scene=atrium size= spp= seeds=4 travel=
common=() extra=()
read_options quick scene= size= spp= seeds= travel= set++=common row+=extra -- "$@"
out=${operands[0]:-$root/build/truth}
: "${travel:=$((quick ? 20 : 60))}" "${spp:=$((quick ? 256 : 4096))}" "${size:=$((quick ? 128 : 320))x$((quick ? 72 : 180))}"
mkdir -p "$out"
build_programs

truth_rays=4096
rows=("")
rows+=(cut.mode={knn,nearest,leaves,refined})
rows+=(samples.mode={uniform,seeded,seeded+kmeans})
rows+=(samples.iterations={0,2,3})
rows+=(denoise.passes=0)
if ((quick)); then
    truth_rays=256
    common=(--set photons.count=20000 --set caustics.photons=20000 --set samples.count=1024 --set gather.rays=64 "${common[@]}")
    rows+=(samples.count={256,1024} gather.rays={16,64})
else
    rows+=(samples.count={1024,2048,4096,8192,16384} gather.rays={64,128,256,512,1024})
fi

package=$(package_of "$scene")
[[ -n $package ]] || exit 0
reference=$(reference_of "$package" "$size" "$spp" all)

# Prints one row. $1: what is changed, NAME=VALUE separated by spaces; further arguments go to lumicut-bench converge.
print_row() {
    local row=$1 changes=() change result
    shift
    for change in $row; do
        changes+=(--set "$change")
    done
    result=$("$bin/lumicut-bench" converge "$package" "$reference" --frames 1 --seeds "$seeds" --stages \
        ${common[@]+"${common[@]}"} ${changes[@]+"${changes[@]}"} "$@")
    awk -v changed="${row:-(nothing)}" '
        $1 == 1 { ratio = ($3 + $4 + $5) / 3; relmse = $6; trimmed = $7 }
        $1 == "stage" { ms[$2] = $3 }
        END {
            printf "%-36s %9.3g %9.3g %7.4f  %9.3f %9.3f %9.3f %9.3f %9.3f\n", changed, relmse, trimmed, ratio, ms["frame"], ms["cut"],
                ms["samples"], ms["gather"], ms["interpolate"]
        }' <<<"$result"
}

echo "$scene, $size, first frame, mean of $seeds seeds, against $spp samples a pixel; ${common[*]:-default settings}"
printf '%-36s %9s %9s %7s  %9s %9s %9s %9s %9s\n' changed relMSE trimmed ratio 'frame ms' cut samples gather interpol.
for row in "${rows[@]}" ${extra[@]+"${extra[@]}"}; do
    print_row "$row"
done

echo
echo "temporal reuse: the same, the frame as the camera comes to rest there after $travel frames of swaying"
for row in "" reuse.photons=on history.frames=0 antialias.frames=0 "history.frames=0 antialias.frames=0"; do
    print_row "$row" --travel "$travel"
done

echo
"$bin/lumicut-bench" lookup "$package" --size "$size" --repeats "$seeds" --truth-rays "$truth_rays" ${common[@]+"${common[@]}"}
echo
echo "photons.nearest=100 cut.probes=0"
"$bin/lumicut-bench" lookup "$package" --size "$size" --repeats "$seeds" --truth-rays "$truth_rays" ${common[@]+"${common[@]}"} \
    --set photons.nearest=100 --set cut.probes=0
echo "goals: refined <= 2 % mean error, >= 10 x faster than knn"
