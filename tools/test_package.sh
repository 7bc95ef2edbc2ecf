#!/bin/sh
# Shows that the Debian package installs, runs and goes away again in a bare Debian.
# usage: tools/test_package.sh PACKAGE.deb ROOT-FOLDER
# ROOT-FOLDER is made with debootstrap on the first call and used again later. Needs root (chroot) and, for what the
# package depends on, a mirror.
set -eu

if [ $# -ne 2 ]; then
    sed -n '2,5s/^# //p' "$0" >&2
    exit 1
fi
package=$1
root=$2
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}

fail() {
    echo "test_package.sh: error: $1" >&2
    exit 3
}
in_root() {
    chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive "$@"
}

if [ ! -e "$root/.complete" ]; then
    echo "making a bare root in $root"
    debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" || fail "debootstrap did not succeed, see $root.log"
    [ ! -e /etc/resolv.conf ] || cp /etc/resolv.conf "$root/etc/resolv.conf"
    touch "$root/.complete"
fi
files() {
    (cd "$root" && find usr etc opt -xdev ! -path 'usr/share/mime/*' | LC_ALL=C sort)
}

cp "$package" "$root/tmp/lumicut.deb"
in_root apt-get -q -y update >"$root.log" 2>&1 || fail "apt-get update failed, see $root.log"
# What it depends on stays: the comparison below is about the package alone.
depends=$(in_root dpkg-deb -f /tmp/lumicut.deb Depends | sed 's/([^)]*)//g; s/|[^,]*//g; s/,/ /g')
# shellcheck disable=SC2086
in_root apt-get -q -y --no-install-recommends install $depends mesa-vulkan-drivers >>"$root.log" 2>&1 ||
    fail "its dependencies cannot be installed, see $root.log"
before=$(files)

in_root dpkg -i /tmp/lumicut.deb >>"$root.log" 2>&1 || fail "dpkg -i failed, see $root.log"
for program in bench compare compile pkg play scenes; do
    in_root "lumicut-$program" --version | grep -q "^lumicut-$program [0-9]" || fail "lumicut-$program does not start"
    [ -e "$root/usr/share/man/man1/lumicut-$program.1.gz" ] || fail "lumicut-$program has no manual page"
done
in_root sh -ec 'cd /tmp && lumicut-scenes out cornell && lumicut-compile -q out/cornell.glb &&
    lumicut-pkg validate out/cornell.lumi &&
    lumicut-play out/cornell.lumi --headless --frames 1 --size 64x64 --output out/cornell.png' >>"$root.log" 2>&1 ||
    fail "a scene cannot be made, compiled and played, see $root.log"
header=$(od -An -tx1 -N24 "$root/tmp/out/cornell.png" | tr -d ' \n')
[ "$header" = 89504e470d0a1a0a0000000d494844520000004000000040 ] || fail "cornell.png is no PNG of 64 x 64 pixels"

in_root dpkg --purge lumicut >>"$root.log" 2>&1 || fail "dpkg --purge failed, see $root.log"
[ "$(files)" = "$before" ] || fail "files are left behind"
rm -rf "$root/tmp/out" "$root/tmp/lumicut.deb"
echo "the package installs, runs and goes away in a bare Debian"
