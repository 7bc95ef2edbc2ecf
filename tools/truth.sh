#!/usr/bin/env bash
# The accuracy of mode gi: one table of errors against the path-traced reference, with the goals.
#   tools/truth.sh [OPTION...] [OUTDIR]    OUTDIR: packages, references and pictures; default build/truth
#     --quick            small pictures, references of 256 samples, 16 frames
#     --scenes A,B,...   default all that tools/bench/scenes.sh measures and of which the files are there
#     --presets A,B,...  of mode gi; default default,preview
#     --spp N            samples a pixel of the references; default 4096
#     --frames N         frames of the second picture; default 256
#     --size WxH         of all pictures; default 256x256 for the boxes, 256x192 for closed rooms, 320x180 for the rest
#     --terms            also each light-path term alone
#     --noise            also the noise in the errors: a row for a second reference against the first, and the standard
#                        error of the terms' ratios, from four pictures and four references of a quarter of the samples
#     --set NAME=VALUE   a setting of mode gi; repeatable
# Some scenes are compared with a twin scene, in mode reference, too (term "KIND:TWIN"). leak: light that the scene has and its
# twin has not is a leak. same: both look the same, pixel by pixel. equal: both are equally bright, up to noise. like: they
# should be similar, without a goal, because their shapes differ.
# The reference's own noise is part of every error. References are kept and found again by the package's bytes: delete
# them when the path tracer has changed. LUMICUT_BIN=FOLDER uses the programs there instead of building.
# Exit code 4 where a picture could not be rendered, else 0, whatever the errors.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

quick=0 terms=0 noise=0 spp= frames= size= presets=default,preview
scenes=$(measured_scenes)
settings=()
read_options quick terms noise scenes= presets= spp= frames= size= set++=settings -- "$@"
out=${operands[0]:-$root/build/truth}
: "${spp:=$((quick ? 256 : 4096))}" "${frames:=$((quick ? 16 : 256))}"
for scene in ${scenes//,/ }; do
    of_scene "$scene" name >/dev/null
done
mkdir -p "$out"
build_programs

# Pictures of several runs, with other settings, may be made in one folder at a time.
tag=$([[ -z ${settings[*]-} ]] || echo "-$(sha256sum <<<"${settings[*]}" | cut -c 1-6)")
rows=0 goals=0 missed=0 failed=0
declare -A made=()

# picture_of SCENE PRESET TERM FRAMES [SEED]: sets `picture` to that of mode gi, rendered once a run, or that of mode
# reference where PRESET is "-". Fails where it cannot be rendered. Wants the scene's `package` and `scene_size`.
picture_of() {
    local log=$out/gi-$$.log
    if [[ $2 == - ]]; then
        picture=$(reference_of "$package" "$scene_size" "$spp" "$3" "${5:-0}") || return 1
        return
    fi
    picture=$out/gi-$1-$2-$scene_size-$3-$4$([[ -z ${5-} ]] || echo "-$5")$tag.exr
    [[ -z ${made[$picture]-} ]] || return 0
    "$bin/lumicut-play" "$package" --headless --mode gi --preset "$2" --size "$scene_size" --frames "$4" --seed "${5:-0}" \
        --set "term=$3" ${settings[@]+"${settings[@]}"} --output "$picture" 2>"$log" || { cat "$log" >&2 && return 1; }
    rm -f "$log"
    made[$picture]=1
}

# noise_of SCENE PRESET TERM FRAMES: the standard error of a picture's mean ratios, for each channel.
noise_of() {
    local reference number
    picture_of "$1" - "$3" "$4" || return
    reference=$picture
    for number in 1 2 3 4; do
        "$bin/lumicut-compare" "$reference" "$(reference_of "$package" "$scene_size" $((spp / 4)) "$3" "$number")" --tsv || return
        picture_of "$1" "$2" "$3" "$4" "$number" || return
        "$bin/lumicut-compare" "$reference" "$picture" --tsv || return
    done | awk -F '\t' '
        # Lines of references and pictures take turns. A reference of all samples has half the error of one of a quarter.
        { for (i = 1; i <= 3; ++i) { sum[NR % 2, i] += $i; squares[NR % 2, i] += $i * $i } }
        function variance(which, i,    mean) { mean = sum[which, i] / 4; v = (squares[which, i] / 4 - mean * mean) * 4 / 3; return v > 0 ? v : 0 }
        END { if (NR != 8) exit 1; for (i = 1; i <= 3; ++i) printf "\t%g", sqrt(variance(1, i) / 4 + variance(0, i)) }'
}

# print_row SCENE PRESET TERM FRAMES FIGURES: one row with its goals, from lumicut-compare's --tsv and what noise_of adds.
# Adds to `rows`, `goals` and `missed`.
print_row() {
    local row
    row=$(awk -F '\t' -v scene="$1" -v preset="$2" -v term="$3" -v frames="$4" -v last="$frames" -v most_flip="$(of_scene "$1" flip)" '
        function judged(name, good) { verdict = verdict " " name (good ? " ok" : " MISSED") }
        function within(slack,    i) { for (i = 1; i <= 3; ++i) if ($i < 1 - slack || $i > 1 + slack) return 0; return 1 }
        function range(slack) { return "ratio " (1 - slack) "-" (1 + slack) }
        # Beyond the slack, but not surely so (95 % at 3 degrees of freedom): neither met nor missed.
        function open(slack,    i) { for (i = 1; i <= 3; ++i) if ($i < 1 - slack - 3.18 * $(10 + i) || $i > 1 + slack + 3.18 * $(10 + i)) return 0; return 1 }
        function largest(    i, most) { for (i = 11; i <= 13; ++i) if ($i > most) most = $i; return most }
        function greatest_leak(    i, most) { for (i = 1; i <= 3; ++i) if ($i - 1 > most) most = $i - 1; return most + 0 }
        function alike(slack) { judged(range(slack) " or noise (z " sprintf("%.1f", $9) ")", within(slack) || ($9 >= -3 && $9 <= 3)) }
        function judgeTwin(kind) {
            if (kind == "like") verdict = sprintf(" mean difference %.4f", $10)
            else if (kind == "same") judged(sprintf("mean difference %.4f<=0.01", $10), $10 <= 0.01)
            else if (kind == "equal" || preset == "-") alike(frames == 1 ? 0.02 : 0.005)
            else judged(sprintf("leak %.4f<=0.005", greatest_leak()), greatest_leak() <= 0.005)
        }
        function judgeTerm() {
            if (!within(0.03) && NF > 10 && open(0.03)) verdict = " ratio 0.97-1.03 open"
            else judged("ratio 0.97-1.03", within(0.03))
            if (NF > 10) verdict = verdict sprintf(" (+-%.4f)", largest())
        }
        function judgeAll() {
            if (preset == "preview") { if (frames == 1) judged(range(0.04), within(0.04)); return }
            judged(range(frames == 1 ? 0.02 : 0.005), within(frames == 1 ? 0.02 : 0.005))
            if (frames == 1) judged("LDR-FLIP<=" most_flip, $6 <= most_flip)
            else if (frames >= 256) judged("relMSE<=0.001", $4 <= 0.001)
        }
        {
            if (frames == "noise") verdict = " (the reference against itself)"
            else if (split(term, kind, ":") == 2) judgeTwin(kind[1])
            else if (term != "all") judgeTerm()
            else judgeAll()
            if ($8 > 0) judged($8 " non-finite pixels", 0)
            printf "%-10s %-8s %-21s %6s  %7.4f %7.4f %7.4f  %9.3g %9.3g  %8.4f %8.4f  %s\n", scene, preset, term, frames, $1, $2, $3,
                $4, $5, $6, $7, substr(verdict, 2)
        }' <<<"$5")
    echo "$row"
    local met=${row//" ok"/} unmet=${row//MISSED/}
    ((rows += 1, missed += (${#row} - ${#unmet}) / 6, goals += (${#row} - ${#unmet}) / 6 + (${#row} - ${#met}) / 3)) || :
}

# compare_row SCENE PRESET TERM FRAMES REFERENCE PICTURE [ERROR]
compare_row() {
    local figures
    figures=$("$bin/lumicut-compare" "$5" "$6" --tsv) || { failed_row "$@" && return; }
    print_row "$1" "$2" "$3" "$4" "$figures${7-}"
}

failed_row() {
    printf '%-10s %-8s %-21s %6s  FAILED to run\n' "$1" "$2" "$3" "$4"
    ((rows += 1, failed += 1))
}

# row SCENE PRESET TERM FRAMES: of a second reference where FRAMES is "noise"
row() {
    local reference error=
    picture_of "$1" - "$3" "$4" || { failed_row "$@" && return; }
    reference=$picture
    if [[ $4 == noise ]]; then
        picture_of "$1" - "$3" "$4" 5 || { failed_row "$@" && return; }
    else
        if ((noise)) && [[ $3 != all ]]; then
            error=$(noise_of "$@") || { failed_row "$@" && return; }
        fi
        picture_of "$@" || { failed_row "$@" && return; }
    fi
    compare_row "$@" "$reference" "$picture" "$error"
}

# twin_row SCENE PRESET KIND:TWIN FRAMES: the twin's picture is the reference
twin_row() {
    local other own=$package
    package=$(package_of "${3#*:}") && picture_of "${3#*:}" "$2" all "$4" || { package=$own && failed_row "$@" && return; }
    other=$picture package=$own
    picture_of "$1" "$2" all "$4" || { failed_row "$@" && return; }
    compare_row "$@" "$other" "$picture"
}

# scene_rows SCENE: all of them
scene_rows() {
    local preset count term measure measured
    package=$(package_of "$1") || { failed_row "$1" - all - && return; }
    [[ -n $package ]] || return 0
    scene_size=${size:-$(of_scene "$1" "$( ((quick)) && echo quick || echo size)")}
    measured=$(of_scene "$1" measured)
    for preset in ${presets//,/ }; do
        for count in 1 "$frames"; do
            row "$1" "$preset" all "$count"
        done
        if ((terms)); then
            for term in emission direct caustics indirect glossy; do
                row "$1" "$preset" $term "$frames"
            done
        fi
    done
    if ((noise)); then
        row "$1" - all noise
    fi
    for measure in ${measured//,/ }; do
        [[ $measure == *:* ]] || continue
        twin_row "$1" - "$measure" -
        for preset in ${presets//,/ }; do
            for count in 1 "$frames"; do
                twin_row "$1" "$preset" "$measure" "$count"
            done
        done
    done
}

echo "mode gi against the reference at $spp samples a pixel; ${settings[*]:-default settings}"
printf '%-10s %-8s %-21s %6s  %7s %7s %7s  %9s %9s  %8s %8s  %s\n' \
    scene preset term frames 'ratio R' 'ratio G' 'ratio B' relMSE trimmed LDR-FLIP HDR-FLIP goals
for scene in ${scenes//,/ }; do
    scene_rows "$scene"
done
echo "$rows rows, $goals goals, $missed missed, $failed failed to run"
((failed == 0)) || exit 4
