# What toolchain/image/test asks of the machine: a function check_NAME each, which prints figures and fails with 1.
# shellcheck shell=bash

image=out/image/test.img

say_wrong() { echo "wrong: $*" && wrong=1; }
expect() { [[ "$2" == "$3" ]] || say_wrong "$1 is '$2', not '$3'"; }
expect_below() { awk -v is="$2" -v below="$3" 'BEGIN { exit !(is < below) }' || say_wrong "$1 takes $2 s, not below $3 s"; }
seconds_since() { awk -v from="$1" -v to="$(date +%s.%N)" 'BEGIN { printf "%.2f", to - from }'; }

# Boots a new machine with the image unless one runs.
need_machine() {
    [[ -n $machine_process ]] && kill -0 "$machine_process" 2>/dev/null && return
    new_machine "$image" && boot_again 90 && wait_until_up
}

wait_until_up() {
    local state
    state=$(on_machine 'timeout 60 systemctl is-system-running --wait')
    [[ $state == running ]] || { say_wrong "the system is $state:" && on_machine systemctl --failed --no-legend --plain; return 1; }
    on_machine hitchview await --panoramas 30 --within 40 || say_wrong "no panoramas"
}

property() { on_machine systemctl show --value --property "$2" "$1"; }
running_release() { on_machine 'cat "$(dirname "$(readlink "/proc/$(systemctl show --value --property MainPID hitchview.service)/exe")")/../release"'; }

nothing_failed() {
    local failed
    failed=$(on_machine systemctl --failed --no-legend --plain)
    [[ -z $failed ]] || { say_wrong "failed: $failed" && on_machine journalctl --boot --unit 'hitchview*' --no-pager --lines 20; }
}

# From the kernel's start: kernel, services before the program, the program until its first panorama was sent.
boot_times() {
    local unit=hitchview.service
    # systemd counts from the kernel's start.
    on_machine systemctl show $unit --property ExecMainStartTimestampMonotonic --property ActiveEnterTimestampMonotonic \
        --property UserspaceTimestampMonotonic
    on_machine systemctl show --property UserspaceTimestampMonotonic
}

check_boot() {
    cut_power
    new_machine "$image"
    boot_again 90 || return 1
    wait_until_up || return 1
    echo "first boot: login $(seconds_since "$machine_started") s after power on, all services up"
    on_machine systemctl poweroff
    wait "$machine_process"
    boot_again 60 || return 1
    wait_until_up || return 1
    nothing_failed
    boot_times | awk -F= '{ at[$1] = $2 / 1e6 }
        END { printf "first panorama %.2f s after the kernel started: kernel %.2f, services before %.2f, program %.2f\n",
            at["ActiveEnterTimestampMonotonic"], at["UserspaceTimestampMonotonic"],
            at["ExecMainStartTimestampMonotonic"] - at["UserspaceTimestampMonotonic"],
            at["ActiveEnterTimestampMonotonic"] - at["ExecMainStartTimestampMonotonic"] }'
    on_machine 'systemd-analyze critical-chain hitchview.service --no-pager' | tail --lines=+4
    return $wrong
}

check_panorama() {
    need_machine || return 1
    on_machine hitchview await --panoramas 90 --within 20 || say_wrong "no panoramas"
    on_machine 'ls /dev/hitchview' | tr '\n' ' '
    expect "number of cameras by name" "$(on_machine 'ls /dev/hitchview | wc -l')" 8
    expect "user of the program" "$(on_machine 'ps -o user= -p "$(systemctl show --value --property MainPID hitchview.service)"')" hitchview
    return $wrong
}

check_sandbox() {
    local unit
    need_machine || return 1
    on_machine systemctl start hitchview-web.service
    for unit in hitchview hitchview-web hitchview-record hitchview-can@vcan0 hitchview-lcm-route hitchview-trial; do
        on_machine systemd-analyze security --no-pager --threshold=20 $unit.service | grep Overall | sed 's/.*level for //' ||
            say_wrong "$unit.service is too exposed"
    done
    expect "seccomp mode" "$(on_machine 'sed -n "s/^Seccomp:\t//p" "/proc/$(systemctl show --value --property MainPID hitchview.service)/status"')" 2
    on_machine hitchview await --panoramas 30 --within 10 || say_wrong "no panoramas within the sandbox"
    on_machine systemctl stop hitchview-web.service
    return $wrong
}

# The program is killed; how long until there is a picture again.
check_kill() {
    local i took
    need_machine || return 1
    for i in 1 2 3; do
        took=$(on_machine 'from=$(date +%s.%N); systemctl kill --signal KILL hitchview.service; hitchview await --panoramas 1 --within 20 >&2 || exit 1
            awk -v from="$from" -v to="$(date +%s.%N)" "BEGIN { printf \"%.2f\", to - from }"') || say_wrong "no picture after kill $i"
        echo "killed: picture after $took s"
        expect_below "a picture after a kill" "$took" 3
        sleep 2
    done
    nothing_failed
    return $wrong
}

# The pipeline's thread stops, the others go on.
check_watchdog() {
    local before took
    need_machine || return 1
    to_machine "$machine_work/stop_thread" /tmp/stop_thread
    before=$(property hitchview.service NRestarts)
    took=$(on_machine 'from=$(date +%s.%N); main=$(systemctl show --value --property MainPID hitchview.service); (/tmp/stop_thread "$main" >/dev/null 2>&1 &)
        for i in $(seq 100); do [ "$(systemctl show --value --property MainPID hitchview.service)" = "$main" ] || break; sleep 0.1; done
        pkill stop_thread || true
        hitchview await --panoramas 1 --within 20 >&2 || exit 1
        awk -v from="$from" -v to="$(date +%s.%N)" "BEGIN { printf \"%.2f\", to - from }"') || say_wrong "no picture after a hang"
    echo "hung: picture again after $took s"
    expect "restarts" "$(property hitchview.service NRestarts)" $((before + 1))
    on_machine journalctl --boot --unit hitchview.service --no-pager --grep watchdog --lines 1 | tail --lines=1
    on_machine 'journalctl --boot --unit hitchview.service --grep "Failed with result .watchdog" --quiet' >/dev/null || say_wrong "not by the watchdog"
    expect_below "a picture after a hang" "$took" 6
    nothing_failed
    return $wrong
}

check_can() {
    need_machine || return 1
    expect "hitchview-can@vcan0" "$(on_machine systemctl is-active hitchview-can@vcan0.service)" active
    on_machine 'ip -brief link show vcan0 | grep --quiet UP' || say_wrong "vcan0 is not up"
    # A bus that goes away and comes back is set up again.
    on_machine 'ip link delete vcan0; ip link add vcan0 type vcan; udevadm settle; sleep 1'
    on_machine 'ip -brief link show vcan0 | grep --quiet UP' || say_wrong "vcan0 is not set up when it comes back"
    return $wrong
}

check_record() {
    need_machine || return 1
    on_machine 'rm -f /var/lib/hitchview/recordings/*; systemctl start hitchview-record.service' || say_wrong "does not start"
    expect "hitchview.service meanwhile" "$(on_machine systemctl is-active hitchview.service)" inactive
    on_machine hitchview await --panoramas 60 --within 20 || say_wrong "no panoramas while it records"
    sleep 3
    on_machine systemctl stop hitchview-record.service
    on_machine hitchview await --panoramas 30 --within 20 || say_wrong "no panoramas afterwards"
    expect "hitchview.service afterwards" "$(on_machine systemctl is-active hitchview.service)" active
    on_machine 'ls -l /var/lib/hitchview/recordings; hitchview check --json /var/lib/hitchview/recordings' >"$machine_work/recording"
    grep --extended-regexp '\.lcm$' "$machine_work/recording" || say_wrong "no recording"
    grep '"damage' --after-context=3 "$machine_work/recording" | head --lines=4
    nothing_failed
    return $wrong
}

check_web() {
    need_machine || return 1
    on_machine systemctl start hitchview-web.service
    ssh "${ssh_options[@]}" -i "$machine_key" -N -L 18080:127.0.0.1:8080 "root@$machine_address" & local tunnel=$!
    sleep 2
    curl --silent --max-time 10 http://127.0.0.1:18080/ | grep --quiet '<title>' || say_wrong "no page"
    ! curl --silent --max-time 3 "http://$machine_address:8080/" >/dev/null || say_wrong "the page is served to the network"
    kill $tunnel
    on_machine systemctl stop hitchview-web.service
    nothing_failed
    return $wrong
}

# The package as a later release in which `hitchview` is what stands on stdin, or the same with a byte more.
make_release() {
    local version=$1 kind=$2 folder=$machine_work/release
    rm --recursive --force "$folder" "$machine_work"/packages
    mkdir --parents "$machine_work/packages"
    dpkg-deb --raw-extract out/packages/hitchview_*_amd64.deb "$folder"
    sed --in-place "s/^Version: .*/Version: $version/" "$folder/DEBIAN/control"
    case $kind in
        good) printf '%s' "$version" >>"$folder/usr/bin/hitchview" ;;
        crashes) printf '#!/bin/sh\nexit 3\n' >"$folder/usr/bin/hitchview" ;;
        cannot_start) printf '#!/nowhere\n' >"$folder/usr/bin/hitchview" ;;
        no_picture) printf '#!/bin/sh\nexec sleep 1000\n' >"$folder/usr/bin/hitchview" ;;
    esac
    (cd "$folder" && find . -path ./DEBIAN -prune -o -type f -printf '%P\0' | xargs --null md5sum >DEBIAN/md5sums)
    dpkg-deb --root-owner-group --build "$folder" "$machine_work/packages/hitchview_${version}_amd64.deb" >/dev/null
}

trial_ends() {
    local end=$((SECONDS + 120))
    while on_machine test -e /opt/hitchview/slots/trial; do
        [[ $SECONDS -lt $end ]] || { say_wrong "the trial does not end" && return; }
        sleep 1
    done
}

update() {
    need_machine || return 1
    make_release "$1" "$2"
    to_machine "$machine_work"/packages/*.deb /tmp/
    on_machine "dpkg --install /tmp/hitchview_$1_amd64.deb" >"$machine_work/dpkg" 2>&1 || { say_wrong "dpkg:" && tail "$machine_work/dpkg"; }
    trial_ends
    on_machine hitchview-slots status
}

check_update_good() {
    update 9.1 good || return 1
    on_machine hitchview await --panoramas 30 --within 20 || say_wrong "no panoramas"
    expect "release that runs" "$(running_release)" 9.1
    nothing_failed
    return $wrong
}

broken_update() {
    local before begun
    need_machine || return 1
    before=$(running_release)
    begun=$(date +%s.%N)
    update "$1" "$2" || return 1
    on_machine hitchview-slots status | grep --quiet "^rolled back $1" || say_wrong "not rolled back"
    on_machine /opt/hitchview/slots/current/bin/hitchview await --panoramas 30 --within 20 || say_wrong "no panoramas"
    echo "picture again $(seconds_since "$begun") s after the broken update began"
    expect "release that runs" "$(running_release)" "$before"
    nothing_failed
    return $wrong
}

check_update_crashes() { broken_update 9.2 crashes; }
check_update_cannot_start() { broken_update 9.3 cannot_start; }
check_update_no_picture() { broken_update 9.4 no_picture; }

# The power goes at any moment of a recording.
check_power_cuts() {
    local i recovered=0 logs=/var/lib/hitchview/recordings newest cut_at
    cut_power
    new_machine "$image" && boot_again 90 && wait_until_up || return 1
    on_machine "sed -i 's#^record: {#record: {folder: $logs, #' /etc/hitchview/rig.yaml && systemctl restart hitchview && sync"
    RANDOM=1
    for ((i = 1; i <= cuts; ++i)); do
        on_machine hitchview await --panoramas 30 --within 30 >/dev/null || { say_wrong "cut $i: no panoramas before it" && break; }
        sleep "$((RANDOM % 6)).$((RANDOM % 10))"
        newest=$(on_machine "ls -t $logs/*.lcm | head -n 1")
        cut_at=$(date +%s.%N)
        cut_power
        boot_again 60 || { say_wrong "cut $i: does not boot" && break; }
        wait_until_up >/dev/null || { say_wrong "cut $i" && break; }
        on_machine "hitchview check $newest --repair /tmp/repaired.lcm >/tmp/said 2>&1; hitchview check --json /tmp/repaired.lcm >/tmp/check.json; cat /tmp/check.json" >"$machine_work/check.json"
        recording_is_whole "$i" "$cut_at" && recovered=$((recovered + 1))
        on_machine "rm -f /tmp/repaired.lcm; ls -t $logs/*.lcm | tail -n +4 | xargs -r rm -f"
    done
    echo "power cut $((i - 1)) times: booted each time, $recovered recordings recovered"
    expect "recordings recovered" "$recovered" "$cuts"
    return $wrong
}

# The repaired recording of a cut at $2: nothing in it damaged or left out, and at most two seconds before the cut missing.
recording_is_whole() {
    python3 - "$machine_work/check.json" "$1" "$2" <<'PYTHON' || { say_wrong "cut $1: the recording is not recovered"; return 1; }
import json, sys
check = json.load(open(sys.argv[1]))
missing_s = float(sys.argv[3]) - check["last_utime_us"] / 1e6
lost = sum(camera["lost"] for camera in check["cameras"].values())
print(f"cut {sys.argv[2]}: {check['events']} events of {check['duration_s']:.1f} s recovered, the last {missing_s:.2f} s missing")
sys.exit(len(check["cameras"]) != 8 or lost > 0 or any(check["damage"].values()) or missing_s > 2)
PYTHON
}

# Each breakage of docs/doctor.md: what it breaks is named, and nothing else; mended, all is well again.
check_doctor() {
    local name break mend answer bad code count=0
    need_machine || return 1
    answer=$(on_machine hitchview doctor --json) || { say_wrong "the sound machine is not: $(bad_checks <<<"$answer")"; return 1; }
    while IFS=$'\t' read -r name break mend; do
        on_machine "$break" || say_wrong "$name: cannot be broken"
        code=0
        answer=$(on_machine hitchview doctor --json) || code=$?
        bad=$(bad_checks <<<"$answer")
        if [[ $bad == "$name" && $code -eq 1 ]]; then echo "$name"; else say_wrong "$break: doctor says '$bad' with exit code $code"; fi
        on_machine "$mend" || say_wrong "$name: cannot be mended"
        answer=$(on_machine hitchview doctor --json) || say_wrong "$name: mended, doctor still says $(bad_checks <<<"$answer")"
        count=$((count + 1))
    done < <(breakages)
    echo "$count breakages"
    [[ $count -ge 12 ]] || say_wrong "fewer than 12 breakages"
    return $wrong
}

bad_checks() { python3 -c 'import json, sys; print(*(c["check"] for c in json.load(sys.stdin)["checks"] if c["verdict"] == "bad"))'; }

# Name, command that breaks, command that mends, of each row of the table.
breakages() {
    awk -F'|' '/^\| breakage/ { table = 1; next } table && !/^\|/ { table = 0 }
        table && $3 ~ /`/ { for (i = 2; i <= 4; ++i) { gsub(/^ *`|` *$/, "", $i); gsub(/&#124;/, "|", $i) } print $2 "\t" $3 "\t" $4 }' docs/doctor.md
}

check_flash() {
    local before
    need_machine || return 1
    before=$(running_release)
    make_release 9.8 good
    toolchain/flash "root@$machine_address" --identity "$machine_key" --packages "$machine_work/packages" \
        --ssh-option StrictHostKeyChecking=no --ssh-option UserKnownHostsFile=/dev/null --ssh-option LogLevel=ERROR || say_wrong "flash fails"
    expect "release that runs" "$(running_release)" 9.8
    toolchain/flash "root@$machine_address" --identity "$machine_key" --rollback \
        --ssh-option StrictHostKeyChecking=no --ssh-option UserKnownHostsFile=/dev/null --ssh-option LogLevel=ERROR || say_wrong "rollback fails"
    on_machine hitchview await --panoramas 30 --within 20 || say_wrong "no panoramas after the rollback"
    expect "release that runs" "$(running_release)" "$before"
    nothing_failed
    return $wrong
}

# Every line `desk$` and `vehicle#` of docs/bring-up.md, in their order, on a machine that has nothing but the system.
check_bring_up() {
    local line where command desk=$machine_work/desk
    cut_power
    new_machine out/image/bare.img && boot_again 90 || return 1
    on_machine 'dpkg --purge hitchview-tools hitchview >/dev/null 2>&1; ! command -v hitchview' || say_wrong "Hitchview is there already"
    rm --recursive --force "$desk"
    mkdir --parents "$desk/bin"
    cp tests/image/{rig.yaml,cameras,can} "$machine_work/board/rig.calib.yaml" "$desk"
    # This machine is nobody's known host, and its key no usual one.
    for command in ssh scp; do
        printf '#!/bin/sh\nexec %s %s -i %s "$@"\n' "$(command -v $command)" "${ssh_options[*]}" "$machine_key" >"$desk/bin/$command"
        chmod +x "$desk/bin/$command"
    done
    while IFS= read -r line; do
        where=${line%%[\$\#] *}
        command=${line#*[\$\#] }
        [[ $command == export* ]] && command="export VEHICLE=root@$machine_address"
        echo "$where: $command"
        case $where in
            desk)
                if [[ $command == export* ]]; then
                    eval "$command"
                else
                    # Scripts of the checkout run there, all else beside the vehicle's own files.
                    ([[ $command == toolchain/* ]] || cd "$desk"; PATH=$desk/bin:$PATH timeout 600 bash -c "$command" </dev/null >"$machine_work/step" 2>&1) || { say_wrong "$command:" && tail "$machine_work/step"; }
                fi ;;
            vehicle)
                if [[ $command == *reboot ]]; then
                    reboot_machine "$command" || return 1
                else
                    on_machine "$command" >"$machine_work/step" 2>&1 || { say_wrong "$command:" && tail --lines=20 "$machine_work/step"; }
                fi ;;
        esac
    done < <(grep --extended-regexp --only-matching '^    (desk\$|vehicle#) .*' docs/bring-up.md | sed 's/^    //')
    pkill --full "8080:127.0.0.1:8080" || true
    nothing_failed
    return $wrong
}

boot_id() { on_machine cat /proc/sys/kernel/random/boot_id 2>/dev/null; }

# By a command of its own; the machine's process goes on.
reboot_machine() {
    local before end=$((SECONDS + 90)) now
    before=$(boot_id)
    on_machine "$1" || true
    until now=$(boot_id) && [[ $now != "$before" ]]; do
        [[ $SECONDS -lt $end ]] || { say_wrong "does not come back" && return 1; }
        sleep 0.5
    done
}

# The images boot by UEFI and make panoramas of a recording.
check_uefi_amd64() {
    cut_power
    toolchain/image/test_uefi amd64
}

check_uefi_arm64() {
    cut_power
    toolchain/image/test_uefi arm64
}
