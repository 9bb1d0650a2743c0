#!/usr/bin/env bash
# install_test.sh BUILD: installs into a folder of its own; from there alone a module is launched, a short
# rig runs live, and its recording is calibrated.
set -euo pipefail
build=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'echo "$0:$LINENO: exit status $?: $BASH_COMMAND" >&2; tail -n 5 live/*.txt live/*.log >&2' ERR
unset VOQCAL_BIN
cmake --install "$build" --prefix "$folder/voqcal" >/dev/null
cd "$folder"

for part in lib/report.html.j2.code config/rigs/acfr_vlp16.yaml lcmtypes/image_t.lcm include/voqcal/image_t.hpp tools/spy; do
  [ -s "voqcal/$part" ] || { echo "$part is not installed" >&2; exit 1; }
done
for program in voqcal/bin/*; do
  # OpenCV's VideoCapture needs it; elsewhere it only makes a program start late.
  [ "$program" = voqcal/bin/camera_driver ] || ! ldd "$program" | grep -E 'imgcodecs|gdal' ||
    { echo "$program loads it" >&2; exit 1; }
done
! grep -rlI "$(dirname "$build")" voqcal || { echo "names the source tree" >&2; exit 1; }

# One command, through a link as the package has it; what it says is of this tree, not of the source's.
ln -s voqcal/tools/voqcal command
for name in up down status run_rig record spy voq_selector calibrate; do
  ./command $name --help >help.txt || { echo "voqcal $name --help fails" >&2; exit 1; }
  ! grep -E 'tools/|build/release' help.txt || { echo "voqcal $name speaks of the source tree" >&2; exit 1; }
done
! ./command no_such 2>message.txt || { echo "voqcal no_such succeeds" >&2; exit 1; }
grep -q "no command 'no_such'" message.txt

sed 's/num_poses: 40/num_poses: 6/' voqcal/config/rigs/simulated_vlp16.yaml >rig.yaml
# Launched, it works until it is told to stop, and then ends well.
voqcal/tools/isolated timeout --preserve-status --signal=INT 3 voqcal/modules/voq_selector/launch rig.yaml

voqcal/tools/isolated voqcal/tools/run_rig rig.yaml --session live --record
./command calibrate --rig rig.yaml --log live/raw.lcm --out offline
cmp live/extrinsic.yaml offline/extrinsic.yaml
[ -s offline/report.html ]
