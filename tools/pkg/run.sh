#!/bin/sh
# Starts the bundled player; arguments are passed on. Without a .lumi file among them it shows the bundle's first scene.
set -u

# This script's own folder, through any symbolic links.
self=$0
while [ -L "$self" ]; do
    link=$(readlink "$self")
    case $link in
    /*) self=$link ;;
    *) self=$(dirname "$self")/$link ;;
    esac
done
here=$(CDPATH='' cd -- "$(dirname -- "$self")" && pwd -P) || exit 2

fail() {
    echo "run.sh: error: $1" >&2
    exit 4
}

# The Vulkan loader and drivers belong to the machine and are never bundled.
has_loader() {
    for ldconfig in ldconfig /sbin/ldconfig /usr/sbin/ldconfig; do
        "$ldconfig" -p 2>/dev/null | grep -q 'libvulkan\.so\.1' && return 0
    done
    # The folders of LD_LIBRARY_PATH are split on purpose.
    # shellcheck disable=SC2046
    for folder in /lib /lib64 /usr/lib /usr/lib64 /usr/local/lib /lib/*-linux-gnu /usr/lib/*-linux-gnu \
        $(echo "${LD_LIBRARY_PATH-}" | tr ':' ' '); do
        [ -e "$folder/libvulkan.so.1" ] && return 0
    done
    return 1
}

has_driver() {
    [ -n "${VK_ICD_FILENAMES-}${VK_DRIVER_FILES-}${VK_ADD_DRIVER_FILES-}" ] && return 0
    for folder in /usr/share /usr/local/share /etc /usr/local/etc "${XDG_DATA_HOME:-${HOME-}/.local/share}" \
        "${XDG_CONFIG_HOME:-${HOME-}/.config}"; do
        for driver in "$folder"/vulkan/icd.d/*.json; do
            [ -e "$driver" ] && return 0
        done
    done
    return 1
}

has_loader || fail "the Vulkan loader libvulkan.so.1 is missing: install the package libvulkan1"
has_driver || fail "no Vulkan driver is installed: install the package mesa-vulkan-drivers or your GPU vendor's driver"

scene=$here/packages/@DEFAULT_PACKAGE@
for argument; do
    case $argument in
    *.lumi) scene= ;;
    esac
done
[ -n "$scene" ] && set -- "$scene" "$@"

# For the player alone: no other program should load the bundled libraries.
LD_LIBRARY_PATH=$here/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} exec "$here/bin/lumicut-play" "$@"
