#!/bin/sh
# Runs a command in a network of its own, where LCM multicast works and reaches nobody else.
#
#     tests/support/lcm_namespace.sh COMMAND [ARGUMENT...]
#
# Exit code: the command's; 77 when this machine does not let us make a network namespace.
set -eu

skip() {
    echo "lcm_namespace: SKIPPED: $1" >&2
    exit 77
}

if [ "${HITCHVIEW_IN_NAMESPACE:-}" = yes ]; then
    ip link set lo up multicast on || skip "cannot bring up the loopback interface"
    ip route add 224.0.0.0/4 dev lo || skip "cannot route multicast to the loopback interface"
    unset HITCHVIEW_IN_NAMESPACE
    exec "$@"
fi

[ $# -gt 0 ] || { echo "usage: $0 COMMAND [ARGUMENT...]" >&2; exit 2; }
command -v ip > /dev/null || skip "the command 'ip' (package iproute2) is not installed"
# An ordinary user becomes root of a user namespace first.
if unshare --net true 2> /dev/null; then
    make_namespace="unshare --net"
elif unshare --map-root-user --net true 2> /dev/null; then
    make_namespace="unshare --map-root-user --net"
else
    skip "network namespaces are not permitted here"
fi
HITCHVIEW_IN_NAMESPACE=yes exec $make_namespace -- "$0" "$@"
