#!/usr/bin/env bash
# The quality of the picture while the camera moves: one table of lumicut-bench motion, with the goals.
#   tools/motion.sh [OPTION...] [OUTDIR]    OUTDIR: packages, and below references/ the references; default build/truth
#     --scenes A,B,...   of tools/bench/scenes.sh; default cornell,atrium,hall,sponza, as far as the files are there
#     --presets A,B,...  of mode gi; default default,preview
#     --paths A,B,...    sway, orbit or files; default sway,orbit
#     --frames N         measured; default 60
#     --spp N            samples a pixel of the references; default 256
#     --size WxH         of all pictures; default 320x180
#     --mode NAME        gi, direct or reference, which is path tracing at one sample a pixel and frame, remembered, filtered and
#                        anti-aliased as mode gi is; default gi
#     --no-ghost         leaves the last columns out, and half of the time
#     --dump             keeps each frame, its reference and its FLIP map below OUTDIR/motion, and a contact sheet of
#                        frames above their references
#     --set NAME=VALUE   a setting; repeatable
#     --device NAME      default the best suitable one
# Columns: mean LDR-FLIP of the frames; flicker F1 above the references', and that without mirrors and caustics; FLIP of
# pixels that the frame before did not show, of the mean; indirect light left one frame, and all light left four frames
# after all lights went off; milliseconds of a frame. LUMICUT_BIN=FOLDER uses the programs there instead of building.
# Exit code 4 where something could not be rendered, else 0, whatever the errors.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

scenes=cornell,atrium,hall,sponza presets=default,preview paths=sway,orbit frames=60 dump=0 out=$root/build/truth
options=()
while (($#)); do
    case $1 in
    --help | -h) usage_of "${BASH_SOURCE[0]}" && exit ;;
    --no-ghost) options+=(--no-ghost) ;;
    --dump) dump=1 ;;
    --scenes | --presets | --paths | --frames | --spp | --size | --mode | --set | --device)
        need_value "$1" $#
        case $1 in
        --scenes) scenes=$2 ;;
        --presets) presets=$2 ;;
        --paths) paths=$2 ;;
        --frames) frames=$2 ;;
        *) options+=("$1" "$2") ;;
        esac
        shift
        ;;
    -*) fail 1 "unknown option $1 (see --help)" ;;
    *) out=$1 ;;
    esac
    shift
done
[[ " ${options[*]-} " == *" --size "* ]] || options+=(--size 320x180)
for scene in ${scenes//,/ }; do
    of_scene "$scene" name >/dev/null
done
mkdir -p "$out"
build_programs
failed=0

# row SCENE PRESET PATH: set `package` first.
row() {
    local result folder
    folder=$out/motion/$1-$2-$(basename "$3")
    local -a extra=()
    ((!dump)) || extra=(--dump "$folder")
    result=$("$bin/lumicut-bench" motion "$package" --path "$3" --preset "$2" --frames "$frames" --cache "$out/references" \
        --set "reference_depth=$(of_scene "$1" depth)" ${options[@]+"${options[@]}"} ${extra[@]+"${extra[@]}"}) ||
        { printf '%-10s %-8s %-8s FAILED to run\n' "$1" "$2" "$3" && failed=1 && return; }
    awk -v scene="$1" -v preset="$2" -v path="$(basename "$3")" '
        function judged(name, value, most) { if (value != "-") verdict = verdict " " name "<=" most (value <= most ? " ok" : " MISSED") }
        /^  moving FLIP/ { flip = $3 }
        /^  flicker F1/ { f1 = $7 }
        /^    without mirrors/ { plain = $5 }
        /^  FLIP where newly seen/ { unseen = $5 }
        /^  light left/ { all = $(NF) }
        /^    of indirect light/ { indirect = $(NF - 1) }
        /^    frame / { ms = $2 }
        END {
            most = scene == "atrium" ? (preset == "preview" ? 0.16 : 0.10) : (preset == "preview" ? 0.10 : 0.06)
            judged("FLIP", flip, most)
            if (preset != "preview") { judged("F1", f1, 0.02); judged("plain", plain, 0.01) }
            judged("newly seen", unseen, 1.5); judged("indirect", indirect, 0.01); judged("all", all, 0.005)
            printf "%-10s %-8s %-8s %8s %8s %8s %8s %9s %8s %9.2f  %s\n", scene, preset, path, flip, f1, plain, unseen, indirect, all, ms, substr(verdict, 2)
        }' <<<"$result"
    ((!dump)) || "$bin/lumicut-sheet" "$folder"/*-frame.png "$folder"/*-reference.png --columns "$frames" -o "$folder.png"
}

printf '%-10s %-8s %-8s %8s %8s %8s %8s %9s %8s %9s  %s\n' scene preset path FLIP F1 plain 'new' indirect all ms goals
for scene in ${scenes//,/ }; do
    package=$(package_of "$scene") || fail 4 "there is no package of $scene"
    [[ -n $package ]] || continue
    for path in ${paths//,/ }; do
        for preset in ${presets//,/ }; do
            row "$scene" "$preset" "$path"
        done
    done
done
exit $((failed ? 4 : 0))
