#!/bin/sh
# Runs a command on one of two hosts that a cable joins: two network namespaces and a pair of virtual Ethernet devices. The command
# runs on 10.66.0.1; it starts programs on the other host, 10.66.0.2, with
#
#     nsenter --net="$HITCHVIEW_OTHER_HOST" PROGRAM
#
#     tests/support/lcm_two_hosts.sh COMMAND [ARGUMENT...]
#
# Exit code: the command's; 77 when this machine does not let us make network namespaces.
set -eu

skip() {
    echo "lcm_two_hosts: SKIPPED: $1" >&2
    exit 77
}

# The address of this host, its cable and the way that multicast takes.
set_up() {
    ip link set lo up multicast on || skip "cannot bring up the loopback interface"
    ip address add "$2/24" dev "$1" || skip "cannot give an address"
    ip link set "$1" up || skip "cannot bring up the cable"
    ip route add 224.0.0.0/4 dev "$1" || skip "cannot route multicast"
}

case ${1:-} in
--this-host)
    shift
    # The other host lives as long as the process that holds it.
    unshare --net sleep infinity &
    holder=$!
    trap 'kill $holder 2> /dev/null' EXIT
    HITCHVIEW_OTHER_HOST=/proc/$holder/ns/net
    export HITCHVIEW_OTHER_HOST
    own=$(readlink /proc/self/ns/net)
    while [ "$(readlink "$HITCHVIEW_OTHER_HOST")" = "$own" ]; do sleep 0.05; done
    ip link add cable0 type veth peer name cable1 || skip "the kernel has no virtual Ethernet"
    ip link set cable1 netns "$holder" || skip "cannot lay the cable"
    set_up cable0 10.66.0.1
    nsenter --net="$HITCHVIEW_OTHER_HOST" "$0" --other-host
    status=0
    "$@" || status=$?
    exit $status
    ;;
--other-host)
    set_up cable1 10.66.0.2
    exit
    ;;
esac

[ $# -gt 0 ] || { echo "usage: $0 COMMAND [ARGUMENT...]" >&2; exit 2; }
command -v ip > /dev/null || skip "the command 'ip' (package iproute2) is not installed"
command -v nsenter > /dev/null || skip "the command 'nsenter' (package util-linux) is not installed"
# An ordinary user becomes root of a user namespace first.
if unshare --net true 2> /dev/null; then
    exec unshare --net -- "$0" --this-host "$@"
elif unshare --map-root-user --net true 2> /dev/null; then
    exec unshare --map-root-user --net -- "$0" --this-host "$@"
fi
skip "network namespaces are not permitted here"
