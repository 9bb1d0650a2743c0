#!/usr/bin/env bash
# tools/demo --real: a folder or a recording of your own through rig, calibration and report.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/rig_scripts.sh"

usage="usage: tools/demo --real RECORDING [--rig FILE] [--camera FILE] [--out DIR] [--lidar-topic NAME] [--image-topic NAME] [KEY=VALUE...]
Calibrates RECORDING and writes a report.
  RECORDING    a session of cam_lidar_calibration, a folder of images and clouds, an LCM log, or a recording of
               ROS: .bag, .mcap, .db3 or their folder
  --rig FILE   the rig file; without it RECORDING/rig.yaml, else DIR/rig.yaml; without these, one is drafted
  --camera FILE, KEY=VALUE   what a drafted rig file must be told (board.width_m=0.61 ...): draft_rig --help
  --out DIR    where files go; logs/real/NAME unless said"

recording='' rig='' out=''
draft_args=() import_args=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) echo "$usage"; exit 0 ;;
    --rig | --out | --camera | --lidar-topic | --image-topic)
      [ $# -ge 2 ] || fail "$1 needs a value"$'\n'"$usage" 2
      case "$1" in
        --rig) rig=$(realpath -m "$2") ;;
        --out) out=$(realpath -m "$2") ;;
        --camera) draft_args+=(--camera "$(realpath -m "$2")") ;;
        *) import_args+=("$1" "$2") ;;
      esac
      shift ;;
    --*) fail "unknown argument '$1'"$'\n'"$usage" 2 ;;
    *.*=*) draft_args+=("$1") ;;
    *)
      [ -z "$recording" ] || fail "two recordings, '$recording' and '$1': one at a time"$'\n'"$usage" 2
      recording=$(realpath -m "$1") ;;
  esac
  shift
done
[ -n "$recording" ] || fail "which recording?"$'\n'"$usage" 2
[ -e "$recording" ] || fail "$recording: there is no such file or folder"
cd "$root"
name=$(basename "$recording")
case "$name" in *.bag | *.mcap | *.db3 | *.zstd | *.lcm) name=${name%%.*} ;; esac
out=${out:-$root/logs/real/$name}

kind_of() {  # RECORDING
  case "$1" in
    *.bag | *.mcap | *.db3 | *.mcap.zstd | *.db3.zstd) echo ros; return ;;
    *.lcm) echo log; return ;;
  esac
  [ -d "$1" ] || return 0
  if [ -n "$(find -L "$1" -maxdepth 1 \( -name '*.bag' -o -name '*.mcap*' -o -name '*.db3*' \) -print -quit)" ]; then
    echo ros
  else
    echo folder
  fi
}
kind=$(kind_of "$recording")
[ -n "$kind" ] || fail "$recording: neither a folder, nor a recording that ends in .bag, .mcap, .db3 or .lcm"
# A rig file is there already, or what is told is for drafting one: both would contradict each other.
[ -n "$rig" ] || [ ! -f "$recording/rig.yaml" ] || rig=$recording/rig.yaml
if [ -n "$rig" ] && [ ${#draft_args[@]} -gt 0 ]; then
  fail "$rig has the rig's numbers: leave out ${draft_args[*]}, or give --rig another file"
fi

# The one that was drafted before of this very recording, perhaps refined since, unless numbers are told anew.
if [ -z "$rig" ] && [ ${#draft_args[@]} -eq 0 ] && [ -f "$out/rig.yaml" ] &&
  [ "$(cat "$out/recording.txt" 2>/dev/null)" = "$recording" ]; then
  rig=$out/rig.yaml
fi

step() { printf '\n== %s ==\n' "$*"; }

# An installed voqcal, and who names another folder of programs, has them.
build() {
  if [ -e CMakeLists.txt ] && [ -z "${VOQCAL_BIN:-}" ]; then tools/build release "$@"; fi
}

if [ -e CMakeLists.txt ] && [ -z "${VOQCAL_BIN:-}" ]; then
  step "set up, build"
  tools/setup
fi
build check_rig draft_rig decode_packets  # these first: who must be asked for numbers is asked soon
require_programs
mkdir -p "$out"
[ -n "$rig" ] || printf '%s\n' "$recording" >"$out/recording.txt"
log=$recording

if [ "$kind" = ros ]; then
  step "import"
  log=$out/$name.lcm
  tools/import_ros "$recording" --out "$log" --force ${import_args[@]+"${import_args[@]}"} ${rig:+--rig "$rig"}
  if [ -z "$rig" ] && [[ " ${draft_args[*]-} " != *" --camera "* ]]; then
    if tools/import_ros "$recording" --print-camera ${import_args[@]+"${import_args[@]}"} >"$out/camera.new" 2>"$out/camera.why"; then
      mv "$out/camera.new" "$out/camera.yaml"
      draft_args+=(--camera "$out/camera.yaml")
    elif ! grep -q "has 0 topics of type" "$out/camera.why"; then  # a recording without CameraInfo is no fault
      fail "$(cat "$out/camera.why")"$'\n'"or give the camera's calibration: --camera FILE"
    fi
    rm -f "$out/camera.new" "$out/camera.why"
  fi
fi

step "rig"
if [ -z "$rig" ]; then
  rig=$out/rig.yaml
  source=$recording
  [ "$kind" != ros ] || source=$log
  "$bin/draft_rig" "$source" ${draft_args[@]+"${draft_args[@]}"} --out "$rig" --force
fi
"$bin/check_rig" "$rig" || [ $? -eq 3 ]  # 3: it can hardly be right, and it has said why

if [ "$kind" = folder ]; then
  step "import"
  log=$out/raw.lcm
  build import_acfr
  "$bin/import_acfr" "$recording" --rig "$rig" --out "$log" --force
fi

step "calibrate"
build calibrate
"$bin/calibrate" --rig "$rig" --log "$log" --out "$out"

step "files"
echo "rig        $rig"
echo "recording  $log"
echo "result     $out/extrinsic.yaml"
echo "report     $out/report.html (for a browser)"
# As draft_rig wrote it down.
estimated=$(sed -n 's/^camera:  # \(estimated from .*\)/\1/p' "$rig")
if [ -n "$estimated" ]; then
  echo "camera     no calibration of it was given: its intrinsics were $estimated."
  echo "           The result is no better than they are; ${program_prefix}calibrate_lens, or --camera FILE, gives better ones."
fi
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open >/dev/null && [ -f "$out/report.html" ]; then
  xdg-open "$out/report.html" >/dev/null 2>&1 || true
fi
