#!/usr/bin/env bash
# Builds and packs a Debian package: tools/package.sh [OUTDIR]     default: build/package
# Equal sources give equal bytes. tools/test_package.sh installs, runs and removes it in a bare root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${1:-build/package}
mkdir -p "$out"
out=$(cd "$out" && pwd)

for tool in dpkg-deb dpkg-shlibdeps strip; do
    command -v $tool >/dev/null || { echo "package: error: $tool is missing; install dpkg-dev" >&2; exit 2; }
done
tools/build.sh release lumicut-{bench,compare,compile,pkg,play,scenes} documentation

version=$(sed -n 's/^project(lumicut VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
maintainer="Lumicut maintainers <lumicut@example.org>"
architecture=$(dpkg --print-architecture)
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
root=$stage/root
# Times of files in the package: those of the commit, so that building twice gives the same.
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || echo 315532800)}

echo "package: installing into a stage"
DESTDIR=$root cmake --install build/release --prefix /usr --strip >"$out/install.log"
doc=$root/usr/share/doc/lumicut
cat >"$doc/copyright" <<END
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: lumicut

Files: *
Copyright: $(date -u -d "@$SOURCE_DATE_EPOCH" +%Y) the Lumicut authors
License: Apache-2.0
 On Debian systems the text of the licence is in /usr/share/common-licenses/Apache-2.0.
END
rm "$doc/LICENSE" # Debian has it, see copyright
gzip -9n "$doc/CHANGELOG.md"
gzip -9n >"$doc/changelog.gz" <<END
lumicut ($version) unstable; urgency=low

  * See CHANGELOG.md.gz.

 -- $maintainer  $(date -u -R -d "@$SOURCE_DATE_EPOCH")
END
gzip -9n "$root"/usr/share/man/man1/*.1
mkdir -p "$root/usr/share/zsh/vendor-completions" # where Debian's zsh looks
mv "$root"/usr/share/zsh/site-functions/* "$root/usr/share/zsh/vendor-completions/"
rmdir "$root/usr/share/zsh/site-functions"

echo "package: asking which libraries it needs"
mkdir -p "$stage/debian"
printf 'Source: lumicut\n\nPackage: lumicut\nArchitecture: any\n' >"$stage/debian/control"
depends=$(cd "$stage" && dpkg-shlibdeps -O root/usr/bin/* 2>"$out/shlibdeps.log" | sed -n 's/^shlibs:Depends=//p')
[[ -n $depends ]] || { cat "$out/shlibdeps.log" >&2; exit 2; }

mkdir -p "$root/DEBIAN"
cat >"$root/DEBIAN/control" <<END
Package: lumicut
Version: $version
Architecture: $architecture
Maintainer: $maintainer
Installed-Size: $(du -sk --exclude=DEBIAN "$root" | cut -f1)
Depends: $depends
Recommends: mesa-vulkan-drivers
Section: graphics
Priority: optional
Description: compiler and player for interactive global illumination
 Lumicut turns a glTF scene into one package and renders that package with
 physically based light on any Vulkan 1.3 device, a CPU included, without
 ray-tracing hardware.
END
(cd "$root" && find usr -type f -print0 | LC_ALL=C sort -z | xargs -0 md5sum >DEBIAN/md5sums)
find "$root" -exec touch -h -d "@$SOURCE_DATE_EPOCH" {} +
chmod -R u=rwX,go=rX "$root"

package=$out/lumicut_${version}_$architecture.deb
dpkg-deb --root-owner-group --build "$root" "$stage/whole.deb" >/dev/null
mv "$stage/whole.deb" "$package"
echo "$package"
