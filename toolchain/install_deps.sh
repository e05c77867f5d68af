#!/usr/bin/env bash
# Installs what Hitchview needs to build and test, from the packages of Debian 12 or Ubuntu 22.04.
# Returns at once when everything is there.
#
#   toolchain/install_deps.sh [--libraries]     --libraries: only prints the packages that Hitchview is compiled against
set -euo pipefail

tools=(
    g++ cmake ninja-build ccache pkg-config liblcm-bin
    iproute2 util-linux qemu-user ffmpeg python3
)
libraries=(
    libeigen3-dev libopencv-dev libhwy-dev liblcm-dev libyaml-cpp-dev libcli11-dev
    nlohmann-json3-dev libturbojpeg0-dev libjpeg-dev libmicrohttpd-dev libceres-dev libapriltag-dev libcairo2-dev
    libgtest-dev libgmock-dev libbenchmark-dev
)
packages=("${tools[@]}" "${libraries[@]}")

# Taken where the release has libcamera 0.0.3 or later: Ubuntu 22.04 has not.
# The second has what its pipelines load, vimc's among them.
optional_packages=(libcamera-dev libcamera-ipa)

# A browser for the tests of the page: Ubuntu has it as a snap only, which this script leaves alone.
browser_packages=(chromium chromium-driver)

# Another calibration program, for the tests that compare with it.
oracle_packages=(mrcal)

if [[ ${1:-} == --libraries ]]; then
    printf '%s\n' "${libraries[@]}"
    exit 0
fi

is_installed() {
    [[ "$(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]
}

# The name under which this release has a package: Ubuntu has also spelled TurboJPEG's without the 0.
package_name() {
    if [[ "$1" == libturbojpeg0-dev ]] && ! apt-cache show "$1" >/dev/null 2>&1; then
        echo libturbojpeg-dev
    else
        echo "$1"
    fi
}

is_satisfied() {
    is_installed "$1" || { [[ "$1" == libturbojpeg0-dev ]] && is_installed libturbojpeg-dev; }
}

as_root() {
    if [[ "$(id --user)" -eq 0 ]]; then "$@"; else sudo "$@"; fi
}

install_once() {
    as_root apt-get update &&
        as_root env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@"
}

if ! command -v dpkg-query >/dev/null; then
    echo "install_deps.sh: no dpkg on this system; install by hand: ${packages[*]}" >&2
    exit 3
fi

install_optional() {
    local version
    is_installed "${optional_packages[0]}" && is_installed "${optional_packages[1]}" && return
    version=$(apt-cache show --no-all-versions "${optional_packages[0]}" 2>/dev/null | sed --quiet 's/^Version: //p')
    [[ -n "$version" ]] && dpkg --compare-versions "$version" ge 0.0.3 || return 0
    install_once "${optional_packages[@]}" || echo "install_deps.sh: goes on without ${optional_packages[*]}" >&2
}

install_browser() {
    is_installed "${browser_packages[0]}" && is_installed "${browser_packages[1]}" && return
    [[ "$(apt-cache policy "${browser_packages[1]}" 2>/dev/null)" == *Candidate:\ [0-9]* ]] || return 0
    install_once "${browser_packages[@]}" || echo "install_deps.sh: goes on without ${browser_packages[*]}" >&2
}

install_oracle() {
    is_installed "${oracle_packages[0]}" && return
    [[ "$(apt-cache policy "${oracle_packages[0]}" 2>/dev/null)" == *Candidate:\ [0-9]* ]] || return 0
    install_once "${oracle_packages[@]}" || echo "install_deps.sh: goes on without ${oracle_packages[*]}" >&2
}

missing=()
for package in "${packages[@]}"; do
    is_satisfied "$package" || missing+=("$package")
done
if [[ ${#missing[@]} -eq 0 ]]; then
    install_optional
    install_browser
    install_oracle
    exit 0
fi

echo "Installing ${missing[*]}"
if [[ " ${missing[*]} " == *" libturbojpeg0-dev "* ]]; then
    as_root apt-get update || true # a fresh image knows no package names yet
fi
names=()
for package in "${missing[@]}"; do
    names+=("$(package_name "$package")")
done

# Mirrors and networks hiccup: one more try, then the error stands.
install_once "${names[@]}" || { sleep 5 && install_once "${names[@]}"; }
install_optional
install_browser
install_oracle
