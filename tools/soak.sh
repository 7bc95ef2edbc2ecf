#!/usr/bin/env bash
# Plays scenes that move in a window for a long time, treated as a restless person would: whether memory stays flat and the
# validation layers silent.
#   tools/soak.sh [OPTION...] MINUTES
#     --scenes A,B,...   of lumicut-scenes; default door,lamp,walker,ball. Each has its part of the time
#     --preset NAME      of mode gi; default preview
#     --size WxH         of the window at first and when memory is read; default 320x180
#     --seed N           of what is done when; default 1
#     --out FOLDER       packages and logs; default build/soak
# On a virtual display, keys choose clips, pause, step, scrub and change the speed, the panel comes and goes, and the window changes
# its size. Memory of the process is read twice a second, in moments when the window has its first size; that of the device is what
# the player says when it is closed, beside a run of a few frames. A scene fails where the layers say something, the player ends in
# another way than by Esc, device memory is another than that of the short run, or the median of the process's memory in the last
# quarter of the time is above that of the second quarter by more than a twentieth. LUMICUT_BIN=FOLDER uses the programs there
# instead of building. Exit code 4 where a scene fails.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/bench/scenes.sh"

scenes=door,lamp,walker,ball preset=preview size=320x180 seed=1 out=$root/build/soak
read_options scenes= preset= size= seed= out= -- "$@"
[[ ${operands[0]-} =~ ^[0-9]+([.][0-9]+)?$ ]] || fail 2 "how many minutes?"
command -v xdotool >/dev/null && command -v Xvfb >/dev/null || fail 2 "xdotool or Xvfb is missing (Debian: xdotool xvfb)"
mkdir -p "$out"
build_programs
seconds=$(awk -v minutes="${operands[0]}" -v count="$(wc -w <<<"${scenes//,/ }")" 'BEGIN { printf "%d", minutes * 60 / count }')
RANDOM=$seed
width=${size%x*} height=${size#*x}

Xvfb -displayfd 3 -screen 0 1280x720x24 3>"$out/display" >"$out/xvfb.log" 2>&1 &
server=$! player=
trap 'kill $player $server 2>/dev/null || true' EXIT
for ((i = 0; i < 100; ++i)); do [[ -s $out/display ]] && break || sleep 0.1; done
DISPLAY=:$(cat "$out/display")
export DISPLAY

# one_of WORD...
one_of() {
    local -a words=("$@")
    printf '%s' "${words[RANDOM % $#]}"
}

rss_kib() { awk '$1 == "VmRSS:" { print $2 }' "/proc/$player/status" 2>/dev/null || echo 0; }

device_bytes() { sed -n 's/.*"device_bytes": \([0-9]*\).*/\1/p' "$1"; }

# median FIRST LAST FILE: of what was read in that part of the time, 0 to 1
median() {
    awk -v first="$1" -v last="$2" -v end="$seconds" '$1 >= first * end && $1 < last * end { print $2 }' "$3" | sort -n |
        awk '{ v[NR] = $1 } END { print NR ? v[int((NR + 1) / 2)] : 0 }'
}

# start PACKAGE STATS LOG OPTION...: the player, in the background; waits for its window
start() {
    "$bin/lumicut-play" "$1" --size "${width}x$height" --preset "$preset" --validate --stats "$2" "${@:4}" >/dev/null 2>"$3" &
    player=$!
}

# disturb WINDOW: does one thing
disturb() {
    case $((RANDOM % 10)) in
    0) xdotool key --window "$1" n ;;
    1 | 2) xdotool key --window "$1" "$(one_of Left Right)" ;;
    3) xdotool key --window "$1" "$(one_of Up Down)" ;;
    4) xdotool key --window "$1" "$(one_of comma period)" ;;
    5 | 6) xdotool key --window "$1" space ;;
    7) xdotool key --window "$1" F1 ;;
    *) xdotool windowsize "$1" $((64 + RANDOM % 400)) $((48 + RANDOM % 300)) ;;
    esac
}

# soak SCENE: fails, or prints a line
soak() {
    local name=$1 package=$out/$1.lumi log=$out/$1.log readings=$out/$1.tsv window= begin
    "$bin/lumicut-scenes" "$out" "$name" >&2
    "$bin/lumicut-compile" "$out/$name.glb" -q -o "$package"
    start "$package" "$out/$name-short.json" "$log" --frames 5
    wait "$player" || fail 4 "$name: a short run failed: $(cat "$log")"
    start "$package" "$out/$name.json" "$log"
    for ((i = 0; i < 600 && ${#window} == 0; ++i)); do
        sleep 0.1
        window=$(xdotool search --onlyvisible --name '^Lumicut - ' 2>/dev/null | head -1 || true)
    done
    [[ -n $window ]] || fail 4 "$name: no window within a minute: $(cat "$log")"
    : >"$readings"
    begin=$SECONDS
    while ((SECONDS - begin < seconds)); do
        for ((i = RANDOM % 6; i >= 0; --i)); do
            disturb "$window"
            sleep 0.$((RANDOM % 5))
        done
        xdotool windowsize "$window" $width $height
        sleep 2 # until a renderer of that size is there again
        for i in 1 2 3 4; do
            printf '%d\t%d\n' $((SECONDS - begin)) "$(rss_kib)" >>"$readings"
            sleep 0.5
        done
        kill -0 "$player" 2>/dev/null || fail 4 "$name: the player is gone: $(cat "$log")"
    done
    xdotool key --window "$window" Escape
    local code=0
    wait "$player" || code=$?
    player=
    local from to short_bytes bytes
    from=$(median 0.25 0.5 "$readings") to=$(median 0.75 1 "$readings")
    short_bytes=$(device_bytes "$out/$name-short.json") bytes=$(device_bytes "$out/$name.json")
    printf '%-8s %5d s  %8.1f %8.1f   %8.1f %8.1f   %s\n' "$name" "$seconds" $((from / 1024)).$((from % 1024 * 10 / 1024)) \
        $((to / 1024)).$((to % 1024 * 10 / 1024)) $((short_bytes >> 20)) $((bytes >> 20)) \
        "$(grep -c 'validation:' "$log" || true) messages"
    ((code == 0)) || fail 4 "$name: exit code $code: $(cat "$log")"
    ! grep -q 'validation:' "$log" || fail 4 "$name: $(grep -m 3 'validation:' "$log")"
    ((to * 20 <= from * 21)) || fail 4 "$name: memory grows from $from to $to KiB"
    ((bytes == short_bytes)) || fail 4 "$name: device memory is $bytes bytes, $short_bytes after a few frames"
}

printf '%-8s %7s  %17s   %17s\n' scene time 'process MiB' 'device MiB'
printf '%-8s %7s  %8s %8s   %8s %8s\n' '' '' '25-50 %' '75-100 %' 'short' 'end'
for scene in ${scenes//,/ }; do soak "$scene"; done
