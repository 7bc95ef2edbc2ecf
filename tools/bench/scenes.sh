# What the measuring scripts share: programs, packages and cached references. Sourced, never run.
# Wants `out`, the folder to write to. Everything that is not the result goes to stderr.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
shared=$root/../shared
bin=${LUMICUT_BIN:-$root/build/release/bin}

fail() {
    echo "$(basename "$0"): error: $2" >&2
    exit "$1"
}

# usage_of SCRIPT: its leading comment.
usage_of() {
    sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$1"
}

# need_value OPTION COUNT: fails where nothing follows the option.
need_value() {
    (($2 >= 2)) || fail 1 "$1 needs a value (see --help)"
}

# Builds, unless LUMICUT_BIN names a folder with the programs.
build_programs() {
    if [[ -z ${LUMICUT_BIN-} ]]; then
        "$root/tools/build.sh" release lumicut-compile lumicut-play lumicut-scenes lumicut-compare lumicut-bench >&2
    fi
}

# source_of SCENE: the glTF file of a scene; nothing where it is not there.
source_of() {
    local file
    case $1 in
    cornell | caustics | atrium)
        file=$out/$1.glb
        if [[ ! -e $file || $bin/lumicut-scenes -nt $file ]]; then
            "$bin/lumicut-scenes" "$out" "$1" >&2
        fi
        ;;
    hall) file=$shared/scenes/scenes/dungeon-hall-cc0.glb ;;
    sponza) file=$shared/scenes/sponza/sponza-textured-draco-webp.glb ;;
    truth_cornell) file=$shared/scenes/truth/cornell.glb ;;
    truth_caustic) file=$shared/scenes/truth/cornell_caustic.glb ;;
    *) fail 1 "there is no scene $1 (see --help)" ;;
    esac
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
    source=$(source_of "$1")
    [[ -n $source ]] || return 0
    if [[ $1 == sponza ]]; then # brings neither camera nor light
        options=(--view bench=-9.41424,3.96726,-0.309525,-8.41424,3.96726,-0.309525,60 --sun=-0.3,-1,-0.2,10)
    fi
    if [[ ! -e $package || $source -nt $package || $bin/lumicut-compile -nt $package ]]; then
        "$bin/lumicut-compile" "$source" -o "$package" -q "${options[@]}" >&2
    fi
    echo "$package"
}

# reference_of PACKAGE SIZE SPP TERM [NUMBER]: the path-traced picture, rendered once for each package, size, count, term
# and number; those of other numbers (default 0) are other samples.
reference_of() {
    local hash picture number=${5:-0}
    hash=$(sha256sum "$1" | cut -c 1-12)
    picture=$out/reference-$(basename "$1" .lumi)-$hash-$2-$3-$4$( ((number)) && echo "-$number" || :).exr
    if [[ ! -e $picture ]]; then
        echo "$(basename "$0"): rendering $(basename "$picture")" >&2
        "$bin/lumicut-play" "$1" --headless --mode reference --size "$2" --spp "$3" --seed $((1000003 + number)) --set "term=$4" \
            --output "$picture" 2>"$out/reference.log" || { cat "$out/reference.log" >&2 && fail 4 "the reference of $1 failed"; }
    fi
    echo "$picture"
}
