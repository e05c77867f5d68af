#!/usr/bin/env bash
# The units as systemd reads them: nothing to complain of, and each service's exposure at most 2.0 of 10.
#
#   tests/integration/systemd_units_test.sh FOLDER      the folder systemd/ of the sources
# Exit code 77: no systemd-analyze here.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo "SKIPPED: no systemd-analyze" && exit 77; }
work=$(mktemp --directory)
trap 'rm --recursive --force "$work"' EXIT

# Programs stand where they are installed; here in a folder of ours.
cp --recursive --no-dereference "$1/system" "$work/units"
mkdir "$work/programs"
for program in hitchview hitchview-web hitchview-slots can-interface lcm-route; do install /bin/true "$work/programs/$program"; done
find "$work/units" -type f -exec sed --in-place --regexp-extended \
    "s#=(/opt/hitchview/slots/current/bin|/usr/sbin|/usr/lib/hitchview)/#=$work/programs/#" {} +
# A template is judged as one of its instances.
mv "$work/units/hitchview-can@.service" "$work/units/hitchview-can@can0.service"
export SYSTEMD_UNIT_PATH=$work/units:

failed=0
for unit in "$work"/units/*.service; do
    name=$(basename "$unit")
    complaints=$(systemd-analyze verify --man=no --recursive-errors=no "$unit" 2>&1) || true
    [[ -z $complaints ]] || { echo "$name: $complaints" && failed=1; }
    systemd-analyze security --offline=yes --threshold=20 "$unit" >"$work/said" 2>&1 || { cat "$work/said" && failed=1; }
    grep Overall "$work/said" | sed 's/.*level for //'
done
exit $failed
