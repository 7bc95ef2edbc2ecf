#!/usr/bin/env bash
# Installs the Debian 12 packages that Lumicut needs and that are not there yet; docs/building.md says what each is for.
#   tools/setup.sh          installs what is missing; where nothing is missing, takes less than a second
#   tools/setup.sh --list   prints the packages
set -euo pipefail

packages=(
    # build
    ccache cmake g++ ninja-build pkg-config
    # shaders, at build time
    glslang-tools spirv-cross spirv-tools
    # package format
    flatbuffers-compiler libflatbuffers-dev libxxhash-dev libzstd-dev
    # compiler
    libdraco-dev libembree-dev libmeshoptimizer-dev libopenmesh-dev libstb-dev libtinygltf-dev libwebp-dev nlohmann-json3-dev
    zlib1g-dev
    # player
    libglfw3-dev libimgui-dev libvulkan-dev mesa-vulkan-drivers
    # tools, and what several programs share
    libarchive-dev libcli11-dev libfmt-dev libopenexr-dev libssl-dev
    # tests
    clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev libgtest-dev python3-jsonschema vulkan-validationlayers xauth xdotool xvfb zstd
    # farms, and their test
    ffmpeg munge parallel slurm-wlm
)

if [[ ${1-} == --list ]]; then
    printf '%s\n' "${packages[@]}"
    exit
fi

fail() {
    echo "setup: error: $*" >&2
    exit 1
}

for tool in apt-get dpkg-query; do
    command -v $tool >/dev/null ||
        fail "there is no $tool here; this script knows Debian 12 only. Install by other means: ${packages[*]}"
done

# dpkg-query exits with 1 for an unknown name; that package then counts as missing.
installed=" $(dpkg-query -W -f='${Package}:${db:Status-Status} ' "${packages[@]}" 2>/dev/null || true)"
missing=()
for package in "${packages[@]}"; do
    [[ $installed == *" $package:installed "* ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    echo "setup: all ${#packages[@]} packages are installed"
    exit
fi
echo "setup: ${#missing[@]} of ${#packages[@]} packages are missing: ${missing[*]}"

as_root=()
if ((EUID != 0)); then
    command -v sudo >/dev/null || fail "installing needs root; run as root: apt-get install ${missing[*]}"
    as_root=(sudo)
fi
# sudo keeps neither variables nor descriptors, so both are set after it: descriptor 3 takes apt's status lines to stdout.
# Descriptor 1 itself would not do: apt closes it for dpkg, and maintainer scripts that print would fail.
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive sh -c 'exec apt-get "$@" 3>&1' apt-get
    -q -y -o Dpkg::Use-Pty=0 -o DPkg::Lock::Timeout=300)

log=$(mktemp)
trap 'rm -f "$log"' EXIT

# phase WORD ARGUMENT...: runs apt-get. Its status lines (KIND:NAME:PERCENT:TEXT) become a line of ours every 20 percent;
# the rest is shown only where it fails.
phase() {
    local word=$1
    shift
    if ! "${apt[@]}" -o APT::Status-Fd=3 "$@" 2>&1 | awk -F: -v word="$word" -v log_file="$log" '
        $1 != "dlstatus" && $1 != "pmstatus" { print >>log_file; next }
        $3 >= shown + 20 { shown = int($3 / 20) * 20; print "setup: " word " " shown " %"; fflush() }'; then
        tail -n 40 "$log" >&2
        fail "$word failed; apt-get said the above"
    fi
}

echo "setup: refreshing the package lists"
"${apt[@]}" update >"$log" 2>&1 || { tail -n 20 "$log" >&2; fail "apt-get update failed; is there a network?"; }
phase "downloading" install --no-install-recommends --download-only "${missing[@]}"
phase "installing" install --no-install-recommends "${missing[@]}"
echo "setup: done"
