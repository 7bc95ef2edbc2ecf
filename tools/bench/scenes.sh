# What the scripts that compile and render share: programs, packages and cached references. Sourced, never run.
# Wants `out`, the folder to write to. Everything that is not the result goes to stderr.

. "$(dirname "${BASH_SOURCE[0]}")/options.sh"

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
shared=$root/../shared
bin=${LUMICUT_BIN:-$root/build/release/bin}

# Builds, unless LUMICUT_BIN names a folder with the programs.
build_programs() {
    if [[ -z ${LUMICUT_BIN-} ]]; then
        "$root/tools/build.sh" release lumicut-compile lumicut-play lumicut-scenes lumicut-compare lumicut-bench lumicut-sheet >&2
    fi
}

# The scenes that the scripts know. size, quick: of pictures, and of those with --quick. flip: most LDR-FLIP of a first frame.
# depth: most vertices of a path of the reference. measured: what truth.sh looks at, comma-separated; "truth" is mode gi against
# the reference, KIND:TWIN the scene against another one (see there), "-" nothing unless asked for. file: under shared/ where
# lumicut-scenes does not make it; options of its compilation follow.
scene_table='
name             size    quick  flip depth measured                   file
cornell          256x256 96x96  0.06 64    truth
caustics         256x256 96x96  0.06 64    truth
atrium           320x180 128x72 0.08 64    truth
hall             320x180 128x72 0.08 64    truth                      scenes/scenes/dungeon-hall-cc0.glb
sponza           320x180 128x72 0.08 64    truth                      scenes/sponza/sponza-textured-draco-webp.glb --view bench=-9.41424,3.96726,-0.309525,-8.41424,3.96726,-0.309525,60 --sun=-0.3,-1,-0.2,10
sheets           320x180 128x72 0.08 64    truth
small            320x180 128x72 0.08 64    truth,equal:sheets
large            320x180 128x72 0.08 64    truth,equal:sheets
slot             320x180 128x72 0.08 64    truth
bright80         256x192 96x72  0.06 128   truth
bright90         256x192 96x72  0.06 256   truth
bright95         256x192 96x72  0.06 512   truth
neighbours       256x192 96x72  0.08 64    truth,leak:neighbours_alone
neighbours_alone 256x192 96x72  0.08 64    -
plain0           320x180 128x72 0.08 64    truth
plain1           320x180 128x72 0.08 64    truth
plain10          320x180 128x72 0.08 64    truth
far              320x180 128x72 0.08 64    truth,same:far_local
far_local        320x180 128x72 0.08 64    -
decal            320x180 128x72 0.08 64    truth,equal:decal_none
decal_none       320x180 128x72 0.08 64    -
terminator       320x180 128x72 0.08 64    truth,like:terminator_fine
terminator_fine  320x180 128x72 0.08 64    -
flipped          320x180 128x72 0.08 64    truth,equal:flipped_agreed
flipped_agreed   320x180 128x72 0.08 64    -
shield           320x180 128x72 0.08 64    truth,leak:shield_unlit
shield_unlit     320x180 128x72 0.08 64    -
truth_cornell    256x256 96x96  0.06 64    -                          scenes/truth/cornell.glb
truth_caustic    256x256 96x96  0.06 64    -                          scenes/truth/cornell_caustic.glb
'

# measured_scenes: the names of those that truth.sh measures unless told otherwise.
measured_scenes() {
    awk 'NF && $1 != "name" && $6 != "-" { print $1 }' <<<"$scene_table"
}

# of_scene SCENE COLUMN: its entry there; "options": all that follow the file.
of_scene() {
    awk -v scene="$1" -v column="$2" '
        $1 == "name" { for (i = 1; i <= NF; ++i) at[$i] = i }
        $1 == scene { found = 1; if (column != "options") print $at[column]; else for (i = at["file"] + 1; i <= NF; ++i) print $i }
        END { exit !found }' <<<"$scene_table" || fail 1 "there is no scene $1 (see --help)"
}

# source_of SCENE: the glTF file of a scene; nothing where it is not there.
source_of() {
    local file
    file=$(of_scene "$1" file) || exit
    if [[ -n $file ]]; then
        file=$shared/$file
    else
        file=$out/$1.glb
        if [[ ! -e $file || $bin/lumicut-scenes -nt $file ]]; then
            "$bin/lumicut-scenes" "$out" "$1" >&2
        fi
    fi
    if [[ -e $file ]]; then
        echo "$file"
    else
        echo "$(basename "$0"): skipping $1: there is no $file" >&2
    fi
}

# package_of SCENE: its package, compiled where it is out of date; nothing where its source is not there.
package_of() {
    local source package=$out/$1.lumi
    local -a options=()
    source=$(source_of "$1") || exit
    [[ -n $source ]] || return 0
    mapfile -t options < <(of_scene "$1" options)
    if [[ ! -e $package || $source -nt $package || $bin/lumicut-compile -nt $package ]]; then
        "$bin/lumicut-compile" "$source" -o "$package" -q ${options[@]+"${options[@]}"} >&2
    fi
    echo "$package"
}

# reference_of PACKAGE SIZE SPP TERM [NUMBER]: the path-traced picture, rendered once for each package, size, count, term
# and number; those of other numbers (default 0) are other samples. Several scripts may do so at a time.
reference_of() {
    local hash scene depth picture log=$out/reference-$$-$BASHPID.log number=${5:-0}
    scene=$(basename "$1" .lumi)
    depth=$(of_scene "$scene" depth) || exit
    hash=$(sha256sum "$1" | cut -c 1-12)
    picture=$out/reference-$scene-$hash-$2-$3-$4$( ((number)) && echo "-$number" || :).exr
    if [[ ! -e $picture ]]; then
        echo "$(basename "$0"): rendering $(basename "$picture")" >&2
        "$bin/lumicut-play" "$1" --headless --mode reference --size "$2" --spp "$3" --seed $((1000003 + number)) --set "term=$4" \
            --set "reference_depth=$depth" --output "$picture" 2>"$log" || { cat "$log" >&2 && fail 4 "the reference of $1 failed"; }
        rm -f "$log"
    fi
    echo "$picture"
}
