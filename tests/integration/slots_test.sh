#!/usr/bin/env bash
# hitchview-slots with programs that are scripts: installs, trials, rollbacks, and a power cut at every step of each.
#
#   tests/integration/slots_test.sh PATH/TO/hitchview-slots
set -uo pipefail
script=$(realpath "$1")
# In memory where programs may run there: every step waits for the disk.
work=$(mktemp --directory --tmpdir=/dev/shm 2>/dev/null || mktemp --directory)
if ! { cp /bin/true "$work" && "$work/true"; }; then
    rm --recursive --force "$work"
    work=$(mktemp --directory)
fi
trap 'rm --recursive --force "$work"' EXIT
export HITCHVIEW_SLOTS=$work/opt/hitchview/slots HITCHVIEW_PROGRAMS=$work/bin HITCHVIEW_RIG=$work/rig.yaml
slots=$HITCHVIEW_SLOTS
failures=0

fail() { echo "FAILED: $*" && failures=$((failures + 1)); }
expect() { [[ "$2" == "$3" ]] || fail "$1: expected '$3', got '$2'"; }
run() { (sh "$script" "$@"; exit $?) >>"$work/said" 2>&1; }
runs_now() { "$slots/current/bin/hitchview" --version 2>/dev/null; }
value() { sed --quiet "s/^$2=//p" "$slots/$1" 2>/dev/null; }

# Programs of release $1 in /usr/bin; `await` of it answers $2.
unpack() {
    mkdir --parents "$HITCHVIEW_PROGRAMS"
    printf '#!/bin/sh\ncase $1 in --version) echo %s ;; await) echo "$@" >>%s/awaited; exit %s ;; esac\n' "$1" "$work" "${2:-0}" \
        >"$HITCHVIEW_PROGRAMS/hitchview"
    cp "$HITCHVIEW_PROGRAMS/hitchview" "$HITCHVIEW_PROGRAMS/hitchview-web"
    chmod +x "$HITCHVIEW_PROGRAMS"/*
}

# A machine on which releases $1 ... were installed and have proved themselves; what their `await` answers is left to each test.
machine() {
    local release
    rm --recursive --force "$work/opt" "$work/bin" "$work/awaited"
    touch "$HITCHVIEW_RIG"
    for release in "$@"; do unpack "$release" 0 && run install "$release" && run judge || fail "cannot install $release"; done
}

first_install_runs_at_once() {
    machine
    run status
    expect "status without a release" $? 3
    unpack 0.1 && run install 0.1
    expect "install" $? 0
    expect "release" "$(runs_now)" 0.1
    [[ ! -e $slots/trial ]] || fail "the first release is on trial"
}

update_is_on_trial_and_proves_itself() {
    machine 0.1
    unpack 0.2 && run install 0.2
    expect "release on trial" "$(runs_now)" 0.2
    expect "boots left" "$(value trial boots_left)" 3
    HITCHVIEW_TRIAL_PANORAMAS=42 HITCHVIEW_TRIAL_SECONDS=7 run judge
    expect "judge" $? 0
    expect "asked of the pictures" "$(tail --lines=1 "$work/awaited")" "await --rig $HITCHVIEW_RIG --panoramas 42 --within 7"
    expect "release after the trial" "$(runs_now)" 0.2
    [[ ! -e $slots/trial && ! -e $slots/rolled-back ]] || fail "the trial has not ended"
}

update_without_pictures_is_rolled_back() {
    rm --recursive --force "$work/opt" && unpack 0.1 1 && run install 0.1 # judged by the release before
    unpack 0.2 0 && run install 0.2
    run judge
    expect "judge" $? 1
    expect "release" "$(runs_now)" 0.1
    expect "release that was rolled back" "$(value rolled-back release)" 0.2
    [[ ! -e $slots/trial ]] || fail "still on trial"
    run judge
    expect "judge without a trial" $? 0
    run acknowledge
    [[ ! -e $slots/rolled-back ]] || fail "not acknowledged"
}

new_release_judges_itself_where_the_old_one_cannot() {
    rm --recursive --force "$work/opt" && unpack 0.1 2 && run install 0.1
    unpack 0.2 0 && run install 0.2 && run judge
    expect "release" "$(runs_now)" 0.2
    unpack 0.3 0 && run install 0.3 && unpack 0.3 && run judge
    expect "release" "$(runs_now)" 0.3
}

program_that_cannot_start_is_rolled_back() {
    rm --recursive --force "$work/opt" && unpack 0.1 1 && run install 0.1
    unpack 0.2 && printf '#!/nowhere\n' >"$HITCHVIEW_PROGRAMS/hitchview" && run install 0.2 && run judge
    expect "release" "$(runs_now)" 0.1
}

boots_without_a_verdict_end_the_trial() {
    machine 0.1
    unpack 0.2 && run install 0.2
    printf 'slot=%s\nboots_left=0\n' "$(readlink "$slots/current")" >"$slots/trial"
    run judge
    expect "judge" $? 1
    expect "release" "$(runs_now)" 0.1
}

each_judgement_takes_a_boot() {
    machine 0.1
    unpack 0.2 && run install 0.2
    # Killed while it waits for pictures, as by a power cut.
    printf '#!/bin/sh\nkill -KILL $PPID\n' >"$slots/previous/bin/hitchview"
    for left in 2 1 0; do
        run judge
        expect "boots left" "$(value trial boots_left)" $left
    done
}

update_during_a_trial_keeps_the_good_release() {
    machine 0.1
    unpack 0.2 && run install 0.2
    unpack 0.3 && run install 0.3
    expect "release on trial" "$(runs_now)" 0.3
    run rollback
    expect "release" "$(runs_now)" 0.1
}

rollback_after_the_trial() {
    machine 0.1 0.2
    run rollback "the driver says so"
    expect "rollback" $? 0
    expect "release" "$(runs_now)" 0.1
    expect "reason" "$(value rolled-back why)" "the driver says so"
    run rollback
    expect "rollback to nowhere" $? 3
    expect "release" "$(runs_now)" 0.1
}

same_release_again_changes_nothing() {
    machine 0.1 0.2
    run install 0.2
    expect "previous" "$(cat "$slots/previous/release")" 0.1
    [[ ! -e $slots/trial ]] || fail "on trial again"
}

machine_without_a_rig_takes_it() {
    machine 0.1
    rm "$HITCHVIEW_RIG"
    unpack 0.2 && run install 0.2 && run judge
    expect "release" "$(runs_now)" 0.2
    [[ ! -e $slots/trial ]] || fail "still on trial"
}

wrong_use_is_refused() {
    local words
    for words in "" "install" "installl 1" "install 1 2"; do
        # shellcheck disable=SC2086 # words
        run $words
        expect "exit code of '$words'" $? 2
    done
}

# Every command that changes the disk, until the one whose turn it is: that one comes too late.
make_power_cuts() {
    local command
    mkdir --parents "$work/cuts"
    for command in rm mv ln cp mkdir sync; do
        cat >"$work/cuts/$command" <<CUT
#!/bin/sh
left=\$(cat $work/left)
[ "\$left" -gt 0 ] || { kill -KILL \$PPID; exit 1; }
echo \$((left - 1)) >$work/left
exec $(command -v $command) "\$@"
CUT
    done
    chmod +x "$work"/cuts/*
}

# Cuts the power after so many steps of a command; true once the command has ended before that.
cut_after() {
    local steps=$1
    shift
    echo "$steps" >"$work/left"
    PATH=$work/cuts:$PATH run "$@"
    [[ $? -lt 128 ]]
}

power_cut_during() {
    local what=$1 releases=$2 steps=0 ended=false release
    shift 2
    make_power_cuts
    while ! $ended; do
        # shellcheck disable=SC2086 # words
        machine $releases
        unpack 0.3
        [[ $what != rollback ]] || { run install 0.3 && run judge; }
        cut_after $steps "$@" && ended=true
        release=$(runs_now)
        [[ " $releases 0.3 " == *" $release "* ]] && [[ -n $release || -z $releases ]] || fail "power cut after $steps steps of $what: no whole release runs"
        run install 0.3 && run judge || fail "power cut after $steps steps of $what: no update afterwards"
        expect "power cut after $steps steps of $what, updated" "$(runs_now)" 0.3
        steps=$((steps + 1))
        [[ $steps -lt 200 ]] || { fail "$what never ends" && break; }
    done
    echo "$what: power cut at each of $((steps - 1)) steps"
    [[ $steps -gt 5 ]] || fail "$what has only $steps steps: nothing was cut"
}

first_install_runs_at_once
update_is_on_trial_and_proves_itself
update_without_pictures_is_rolled_back
new_release_judges_itself_where_the_old_one_cannot
program_that_cannot_start_is_rolled_back
boots_without_a_verdict_end_the_trial
each_judgement_takes_a_boot
update_during_a_trial_keeps_the_good_release
rollback_after_the_trial
same_release_again_changes_nothing
machine_without_a_rig_takes_it
wrong_use_is_refused
power_cut_during "first installation" "" install 0.3
power_cut_during update 0.1 install 0.3
power_cut_during "second update" "0.1 0.2" install 0.3
power_cut_during rollback "0.1 0.2" rollback

[[ $failures -eq 0 ]] || { tail --lines=20 "$work/said"; echo "$failures failed"; exit 1; }
echo "all passed"
