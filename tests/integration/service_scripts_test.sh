#!/usr/bin/env bash
# The scripts that units and udev rules call, with an `ip` that writes down what it is told.
#
#   tests/integration/service_scripts_test.sh FOLDER      the folder systemd/lib of the sources
set -uo pipefail
scripts=$(realpath "$1")
work=$(mktemp --directory)
trap 'rm --recursive --force "$work"' EXIT
export HITCHVIEW_CAMERAS=$work/cameras HITCHVIEW_CAN=$work/can HITCHVIEW_NETWORK=$work/network
failures=0
fail() { echo "FAILED: $*" && failures=$((failures + 1)); }
expect() { [[ "$2" == "$3" ]] || fail "$1: expected '$3', got '$2'"; }

mkdir "$work/bin"
printf '#!/bin/sh\necho "$@" >>%s/told\n! grep --quiet -- "${REFUSED:-nothing}" <<WORDS\n$*\nWORDS\n' "$work" >"$work/bin/ip"
chmod +x "$work/bin/ip"
export PATH=$work/bin:$PATH
# What ip was told, and the exit code, of a script.
told() {
    : >"$work/told"
    "$scripts/$1" "${@:2}" >"$work/said" 2>&1
    code=$?
    told=$(paste --serial --delimiters=';' "$work/told")
}

cat >"$HITCHVIEW_CAMERAS" <<'FILE'
# name place or device

tractor-front platform-vivid.0-video-index0
tractor-left  vi-output, ar0234 30-0010
../../etc     platform-vivid.1-video-index0
FILE
name_of() { "$scripts/camera-name" "$@" 2>/dev/null || echo $?; }
expect "a camera named by its place" "$(name_of platform-vivid.0-video-index0 vivid)" tractor-front
expect "a camera named by its device" "$(name_of -video-index0 "vi-output, ar0234 30-0010")" tractor-left
expect "a camera that is not named" "$(name_of platform-vivid.7-video-index0 vi-output)" 1
expect "a name that is a path" "$(name_of platform-vivid.1-video-index0 vivid)" 2

cat >"$HITCHVIEW_CAN" <<'FILE'
# name rate
can0 500000
can1 250000 dbitrate 2000000 fd on
can2 fast
can3 2000000
vcan0 virtual
FILE
told can-interface up can0
expect "can0" "$told" "link set can0 down;link set can0 type can bitrate 500000 restart-ms 100;link set can0 up"
REFUSED=restart-ms told can-interface up can1
expect "a controller that cannot restart" "$told" "link set can1 down;link set can1 type can bitrate 250000 restart-ms 100 dbitrate 2000000 fd on;link set can1 type can bitrate 250000 dbitrate 2000000 fd on;link set can1 up"
told can-interface up vcan0
expect "a virtual interface" "$told" "link set vcan0 up"
told can-interface up can9
expect "an interface that is not named" "$code$told" 0
told can-interface down can0
expect "an interface that is gone, down" "$code$told" 0
for interface in can2 can3; do
    told can-interface up $interface
    expect "a wrong bit rate" "$code$told" 2
    grep --quiet "$HITCHVIEW_CAN: $interface: bit rate" "$work/said" || fail "does not name file and interface: $(cat "$work/said")"
done
REFUSED="bitrate 500000" told can-interface up can0
[[ $code -ne 0 ]] || fail "a refused bit rate goes unnoticed"

echo 'interface=lo' >"$HITCHVIEW_NETWORK"
told lcm-route
expect "lo" "$told" "link set lo up multicast on;route replace 224.0.0.0/4 dev lo"
printf '# display units\ninterface=eth1\n' >"$HITCHVIEW_NETWORK"
told lcm-route
expect "eth1" "$told" "route replace 224.0.0.0/4 dev eth1"
for line in 'interface=' 'interface=a b' 'device=lo' 'interface=$(reboot)'; do
    echo "$line" >"$HITCHVIEW_NETWORK"
    told lcm-route
    expect "network: $line" "$code$told" 2
done

[[ $failures -eq 0 ]] || { echo "$failures failed"; exit 1; }
echo "all passed"
