#!/bin/sh
# Shows that a bundle starts headless on a bare Debian: only the Vulkan loader, a software driver and the X libraries.
# usage: tools/test_bundle.sh BUNDLE.tar.zst ROOT-FOLDER [PLAYER-ARGUMENT...]
# ROOT-FOLDER is made with debootstrap on the first call and used again later. Needs root (chroot).
set -eu

if [ $# -lt 2 ]; then
    sed -n '2,4s/^# //p' "$0" >&2
    exit 1
fi
bundle=$1
root=$2
shift 2
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
needed=libvulkan1,mesa-vulkan-drivers,libx11-6,libx11-xcb1,libxcb1,libxcb-dri3-0,libxcb-present0,libxcb-randr0
needed=$needed,libxcb-sync1,libxshmfence1,libxrandr2,libxinerama1,libxcursor1,libxi6,libwayland-client0,libgl1

fail() {
    echo "test_bundle.sh: error: $1" >&2
    exit 3
}

if [ ! -e "$root/.complete" ]; then
    echo "making a bare root in $root"
    debootstrap --variant=minbase --include="$needed" bookworm "$root" "$mirror" || fail "debootstrap did not succeed"
    touch "$root/.complete"
fi

rm -rf "$root/opt/bundle"
mkdir -p "$root/opt/bundle"
tar --zstd -xf "$bundle" -C "$root/opt/bundle"
folder=$(basename "$bundle" .tar.zst)
[ -x "$root/opt/bundle/$folder/run.sh" ] || fail "the bundle has no run.sh in $folder/"

# Every file is as the manifest says.
(
    cd "$root/opt/bundle/$folder"
    sed -n 's/^ *"path": "\(.*\)",*$/\1/p; s/^ *"sha256": "\(.*\)",*$/\1/p' manifest.json |
        while read -r path && read -r sum; do echo "$sum  $path"; done >/tmp/bundle-sums.$$
    sha256sum --quiet -c /tmp/bundle-sums.$$
    rm -f /tmp/bundle-sums.$$
) || fail "the manifest does not match the files"

# Through a symbolic link, from another folder: the launcher must find its own.
ln -sfn "$folder/run.sh" "$root/opt/bundle/start"
rm -f "$root/tmp/out.png"
chroot "$root" /bin/sh -c 'cd /tmp && exec /opt/bundle/start --headless --frames 1 --size 64x64 --output out.png "$@"' \
    sh "$@" || fail "the player ended with exit code $?"

header=$(od -An -tx1 -N24 "$root/tmp/out.png" | tr -d ' \n')
[ "$header" = 89504e470d0a1a0a0000000d494844520000004000000040 ] || fail "out.png is no PNG of 64 x 64 pixels"
echo "the bundle starts on a bare Debian"

# Without the driver, then without the loader: one sentence, exit code 4.
expect_missing() {
    status=0
    message=$(chroot "$root" /opt/bundle/start --headless 2>&1) || status=$?
    [ "$status" -eq 4 ] || fail "without $1 the launcher ended with $status instead of 4: $message"
    case $message in
    *"$1"*) echo "without $1: $message" ;;
    *) fail "the launcher does not name $1: $message" ;;
    esac
}
restore() {
    [ ! -e "$root/usr/share/vulkan/icd.off" ] || mv "$root/usr/share/vulkan/icd.off" "$root/usr/share/vulkan/icd.d"
    for library in "$root"/usr/lib/*/off.libvulkan.so.1*; do
        if [ -e "$library" ] || [ -L "$library" ]; then
            mv "$library" "${library%/*}/${library##*/off.}"
        fi
    done
    chroot "$root" ldconfig
}
trap restore EXIT
mv "$root/usr/share/vulkan/icd.d" "$root/usr/share/vulkan/icd.off"
expect_missing mesa-vulkan-drivers
for library in "$root"/usr/lib/*/libvulkan.so.1*; do
    mv "$library" "${library%/*}/off.${library##*/}"
done
chroot "$root" ldconfig
expect_missing libvulkan1
