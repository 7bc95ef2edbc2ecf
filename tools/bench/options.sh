# The command lines of scripts, and how they fail. Sourced, never run.

# fail CODE MESSAGE
fail() {
    echo "$(basename "$0"): error: $2" >&2
    exit "$1"
}

# usage_of SCRIPT: its leading comment.
usage_of() {
    awk 'NR > 1 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "$1"
}

# read_options SPEC... -- ARGUMENT...: sets the caller's variables, and the array `operands` to what is no option.
#   NAME               --NAME (-N of one letter) sets the variable NAME to 1
#   NAME=[VARIABLE]    takes a value; the variable is NAME by default, dashes as underscores
#   NAME+=VARIABLE     appends the value to an array
#   NAME++=VARIABLE    appends the option and the value, as programs take them
# --help prints the script's leading comment and ends it.
read_options() {
    local -a specs=()
    local spec option kind target found
    while [[ $1 != -- ]]; do
        specs+=("$1")
        shift
    done
    shift
    operands=()
    while (($#)); do
        if [[ $1 == --help || $1 == -h ]]; then
            usage_of "$0"
            exit
        elif [[ $1 != -?* ]]; then
            operands+=("$1")
            shift
            continue
        fi
        found=0
        for spec in "${specs[@]}"; do
            [[ $spec =~ ^([a-z-]+)(\+{0,2}=)?([a-z_]*)$ ]]
            option=${BASH_REMATCH[1]} kind=${BASH_REMATCH[2]} target=${BASH_REMATCH[3]:-${BASH_REMATCH[1]//-/_}}
            [[ $1 == --$option || (${#option} == 1 && $1 == -$option) ]] || continue
            found=1
            break
        done
        ((found)) || fail 1 "unknown option $1 (see --help)"
        local -n variable=$target
        if [[ -z $kind ]]; then
            variable=1
        else
            (($# >= 2)) || fail 1 "$1 needs a value (see --help)"
            case $kind in
            =) variable=$2 ;;
            +=) variable+=("$2") ;;
            ++=) variable+=("$1" "$2") ;;
            esac
            shift
        fi
        local +n variable
        shift
    done
}
