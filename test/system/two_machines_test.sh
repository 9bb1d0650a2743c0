#!/usr/bin/env bash
# two_machines_test.sh BUILD: drivers on one host, the rest on another, as the README says. The hosts are
# two network namespaces joined by a veth pair: nothing leaves this machine.
set -euo pipefail
build=$(realpath "$1")
root=$(cd "$(dirname "$0")/../.." && pwd)
if [ -z "${VOQCAL_TEST_IS_ISOLATED:-}" ]; then
  flags=(--net)
  [ "$(id -u)" -eq 0 ] || flags+=(--map-root-user)
  VOQCAL_TEST_IS_ISOLATED=1 exec unshare "${flags[@]}" -- "$0" "$@"
fi

folder=$(mktemp -d)
cleanup() {
  on_sensors "$root/tools/down" --session "$folder/sensors" 2>/dev/null || true
  "$root/tools/down" --session "$folder/station" 2>/dev/null || true
  kill "$sensors_pid"
  rm -rf "$folder"
}
export VOQCAL_BIN=$build/bin

# This namespace is the station; the sensors' host is that of a process that sleeps.
unshare --net -- sleep infinity &
sensors_pid=$!
trap cleanup EXIT
until [ "$(readlink "/proc/$sensors_pid/ns/net")" != "$(readlink /proc/self/ns/net)" ]; do sleep 0.1; done
on_sensors() { nsenter --target "$sensors_pid" --net -- "$@"; }
ip link add station type veth peer name sensors netns "$sensors_pid"
for ip in "ip station 10.77.0.1" "on_sensors ip sensors 10.77.0.2"; do
  address=${ip##* } rest=${ip% *}
  device=${rest##* } run=${rest% *}
  $run address add "$address/24" dev "$device"
  $run link set lo up
  $run link set "$device" up
  $run route add 224.0.0.0/4 dev "$device"
done

sed 's/num_poses: 40/num_poses: 6/' "$root/config/rigs/simulated_vlp16.yaml" >"$folder/stays.yaml"
sed 's/ttl=0/ttl=1/' "$folder/stays.yaml" >"$folder/rig.yaml"
sensors=$(grep '_driver$' "$root/modules/names.txt" | paste -sd,)
rest=$(grep -v '_driver$\|^dashboard$' "$root/modules/names.txt" | paste -sd,)

echo "== ttl=0: the sensors' host is not heard =="
on_sensors "$root/tools/up" "$folder/stays.yaml" --session "$folder/sensors" --only $sensors
# The simulated drivers paint their world first.
until on_sensors "$root/tools/status" "$folder/stays.yaml" --once --modules $sensors >/dev/null 2>&1; do :; done
! "$root/tools/status" "$folder/stays.yaml" --once --modules $sensors >"$folder/status.txt" 2>&1
grep '^silent  lidar_driver, camera_driver' "$folder/status.txt"
on_sensors "$root/tools/down" --session "$folder/sensors"

echo "== ttl=1: a session over both =="
"$root/tools/up" "$folder/rig.yaml" --session "$folder/station" --only $rest --record
on_sensors "$root/tools/up" "$folder/rig.yaml" --session "$folder/sensors" --only $sensors
for driver in lidar_driver camera_driver; do
  until grep -q "exited: $driver (exit status 0; expected)" "$folder/sensors/supervisord.log"; do sleep 0.5; done
done
"$build/bin/command" finish --wait 60 --rig "$folder/rig.yaml" ||
  [ $? -eq 3 ]  # of six poses: not to be used yet
"$root/tools/status" "$folder/rig.yaml" --once --modules $rest | tee "$folder/status.txt"
"$root/tools/down" --session "$folder/station"
grep -q '^lost    nothing' "$folder/status.txt"

"$build/bin/calibrate" --rig "$folder/rig.yaml" --log "$folder/station/raw.lcm" --out "$folder/offline" >/dev/null
cmp "$folder/station/extrinsic.yaml" "$folder/offline/extrinsic.yaml"
echo "live over two hosts and offline: the same result, byte for byte"
