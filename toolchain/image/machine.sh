# Virtual machines that run disk images of ours, for scripts to read in: User-Mode Linux with virtual cameras and CAN buses (amd64).
# The machine has its disk, an address and an SSH server; what reads this must be root and should have a network namespace of its own.
#
#   new_machine IMAGE        a disk of its own with what IMAGE holds
#   start_machine            boots it; returns at once
#   wait_for_login SECONDS   until commands can be run
#   on_machine COMMAND...    as root; its exit code and what it prints
#   cut_power                the machine is gone from one moment to the next, the disk stays
#   boot_again SECONDS       starts it and waits for login
# $machine_work (a folder that exists) and $machine_key (private SSH key) are set before.
# shellcheck shell=bash

machine_address=10.77.0.2
machine_kernel=
machine_process=

# Files for the image: what the virtual machine needs and a real one does not.
write_machine_files() {
    local files=$1 kernel i
    kernel=$(toolchain/vm/kernel)
    mkdir --parents "$files"/etc/{systemd/network,modules-load.d,modprobe.d,hitchview,ssh/sshd_config.d} "$files/lib"
    cp --recursive "$kernel/modules/lib/modules" "$files/lib/"
    cat >"$files/etc/systemd/network/10-machine.network" <<NETWORK
[Match]
Name=vec*

[Network]
Address=$machine_address/24
NETWORK
    printf '[NetDev]\nName=vcan0\nKind=vcan\n' >"$files/etc/systemd/network/10-vcan0.netdev"
    printf '[Match]\nName=vcan0\n\n[Link]\nUnmanaged=yes\n' >"$files/etc/systemd/network/11-vcan0.network"
    # The kernel makes more of each of its connections than of a real network's.
    printf 'UseDNS no\nX11Forwarding no\n' >"$files/etc/ssh/sshd_config.d/machine.conf"
    printf 'vivid\nvcan\n' >"$files/etc/modules-load.d/machine.conf"
    local ones=0x1 zeros=0 inputs=1 numbers=0
    for i in 1 2 3 4 5 6 7; do ones+=,0x1 zeros+=,0 inputs+=,1 numbers+=,$i; done
    echo "options vivid n_devs=8 node_types=$ones input_types=$zeros num_inputs=$inputs vid_cap_nr=$numbers" >"$files/etc/modprobe.d/machine.conf"
}

new_machine() {
    machine_disk=$machine_work/disk.img
    machine_kernel=$(toolchain/vm/kernel)
    cp --sparse=always --reflink=auto "$1" "$machine_disk"
    ip link show machine0 >/dev/null 2>&1 || {
        ip link set lo up
        ip link add machine0 type veth peer name machine1
        ip address add 10.77.0.1/24 dev machine0
        # The virtual machine takes no segments larger than a frame.
        ip link set machine0 gso_max_segs 1 gso_max_size 1514
        ip link set machine0 up
        ip link set machine1 up
    }
}

start_machine() {
    mkdir --parents "$machine_work/umid"
    local paced=()
    chrt --rr 1 true 2>/dev/null && paced=(chrt --rr 1)
    machine_started=$(date +%s.%N)
    "${paced[@]}" "$machine_kernel/linux" mem="${machine_memory:-1536M}" ncpus=2 seccomp=on ubd0="$machine_disk" root=/dev/ubda2 rw \
        vec0:transport=raw,ifname=machine1 quiet panic=-1 con=null con0=null,fd:1 ssl=null uml_dir="$machine_work/umid" \
        umid="machine$$" </dev/null >>"$machine_work/console" 2>&1 &
    machine_process=$!
}

ssh_options=(-o StrictHostKeyChecking=no -o UserKnownHostsFile=/dev/null -o LogLevel=ERROR -o ConnectTimeout=3 -o BatchMode=yes)

on_machine() { ssh "${ssh_options[@]}" -i "$machine_key" "root@$machine_address" "$@" </dev/null; }
to_machine() { scp -q "${ssh_options[@]}" -i "$machine_key" "${@:1:$#-1}" "root@$machine_address:${!#}"; }

wait_for_login() {
    local end=$((SECONDS + $1))
    until on_machine true 2>/dev/null; do
        kill -0 "$machine_process" 2>/dev/null || { echo "the machine ended while it booted:" && tail --lines=20 "$machine_work/console" && return 1; }
        [[ $SECONDS -lt $end ]] || { echo "no login within $1 s:" && tail --lines=20 "$machine_work/console" && return 1; }
        sleep 0.2
    done
}

cut_power() {
    [[ -n $machine_process ]] || return 0
    # The kernel is several processes; none of them gets to say anything.
    pkill -KILL --parent "$machine_process" 2>/dev/null || true
    kill -KILL "$machine_process" 2>/dev/null || true
    wait "$machine_process" 2>/dev/null || true
    pkill -KILL --full "umid=machine$$" 2>/dev/null || true
    machine_process=
}

boot_again() { start_machine && wait_for_login "$1"; }
