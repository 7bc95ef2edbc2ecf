#!/usr/bin/env bash
# Convergence of mode gi on two Cornell boxes at 256x256: seconds and relMSE after 1, 2, 4, ... frames, next
# to what Blender's Cycles took. The scenes are not part of the repository; without them the script says so and ends.
#   tools/time_to_truth.sh [OPTION...] [OUTDIR]    OUTDIR: packages and references; default build/truth
#     --quick            references of 512 samples, 8 frames
#     --frames N         default 64
#     --spp N            samples a pixel of the references; default 4096
#     --size WxH         default 256x256; others do not compare with Cycles
#     --preset NAME      of mode gi; default default
#     --set NAME=VALUE   a setting of mode gi; repeatable
# Time is that of recording and rendering frames, programs and kernels being ready. The reference's own noise is part of
# every error. LUMICUT_BIN=FOLDER uses the programs there instead of building.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

spp= frames= quick=0 size=256x256
settings=()
read_options quick frames= spp= size= preset++=settings set++=settings -- "$@"
out=${operands[0]:-$root/build/truth}
: "${spp:=$((quick ? 512 : 4096))}" "${frames:=$((quick ? 8 : 64))}"
if [[ ! -d $shared/scenes/truth ]]; then
    echo "time_to_truth.sh: skipping: there is no $shared/scenes/truth"
    exit
fi
mkdir -p "$out"
build_programs

# cycles SCENE: Blender 3.4.1, CPU, 2 cores, 256x256, against its own long render.
cycles() {
    case $1 in
    truth_cornell) printf '%s\n' '16 spp: 0.71 s, 0.0124' '64 spp: 2.66 s, 0.00265' '256 spp: 11.3 s, 0.000625' '1024 spp: 43.3 s, 0.000173' ;;
    truth_caustic) printf '%s\n' '64 spp: 3.90 s, 0.0378' '256 spp: 14.7 s, 0.00973' ;;
    esac
}

for scene in truth_cornell truth_caustic; do
    package=$(package_of "$scene")
    [[ -n $package ]] || continue
    reference=$(reference_of "$package" "$size" "$spp" all)
    echo "$(basename "$(source_of "$scene")"), $size, against $spp samples a pixel"
    echo " mode gi, ${settings[*]:-default settings}"
    "$bin/lumicut-bench" converge "$package" "$reference" --frames "$frames" ${settings[@]+"${settings[@]}"} | sed 's/^/  /'
    echo " mode reference (a frame is a sample a pixel)"
    "$bin/lumicut-bench" converge "$package" "$reference" --frames "$frames" --mode reference | sed 's/^/  /'
    echo " Cycles on 2 CPU cores: time, relMSE"
    cycles "$scene" | sed 's/^/  /'
done
