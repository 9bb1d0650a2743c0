#!/usr/bin/env bash
# spy_test.sh BUILD [SCREENSHOTS]: lcm-spy with our types and views, in real windows of a display of its own.
set -euo pipefail
build=$(realpath "$1")
root=$(cd "$(dirname "$0")/../.." && pwd)
[ -n "${VOQCAL_TEST_IS_ISOLATED:-}" ] ||
  VOQCAL_TEST_IS_ISOLATED=1 exec "$root/tools/isolated" "$0" "$@"

folder=$(mktemp -d)
trap '"$root/tools/down" --session "$folder/session" || true; kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT
screenshots=${2:-$folder}
mkdir -p "$screenshots"
export VOQCAL_BIN=$build/bin

Xvfb -displayfd 3 -screen 0 1280x1024x24 -nolisten tcp 3>"$folder/display" 2>"$folder/Xvfb.txt" &
until [ -s "$folder/display" ]; do sleep 0.1; done
DISPLAY=:$(cat "$folder/display")
export DISPLAY

# The board rests long: on a slow machine Java is not ready within the minute that the rig takes as it is.
rig=$folder/rig.yaml
sed 's/hold_s: 1.0/hold_s: 20.0/' "$root/config/rigs/simulated_vlp16.yaml" >"$rig"
"$root/tools/up" "$rig" --session "$folder/session" \
  --only lidar_driver,camera_driver,lidar_board_detector,camera_board_detector
VOQCAL_SPY="$root/test/system/SpyTest.java $screenshots" "$root/tools/spy" "$rig"
