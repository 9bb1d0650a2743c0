# Sourced by the scripts that run a rig: where things are, and what the modules are called.
# Works in a source tree (programs in build/release/bin) and in an installed one (bin).

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
bin=${VOQCAL_BIN:-$root/bin}
[ -d "$bin" ] || bin=$root/build/release/bin
# What messages call things: the source tree has set-up and build, an installed one the command voqcal.
if [ -e "$root/CMakeLists.txt" ]; then
  tool_prefix=tools/ program_prefix=build/release/bin/
  how_to_install() { echo "tools/setup installs it"; }  # PACKAGE
  how_to_build="run tools/build"
else
  tool_prefix='voqcal ' program_prefix='voqcal '
  how_to_install() { echo "apt-get install $1 installs it"; }
  how_to_build="install the package again"
fi

# What a session of the rig runs, by the programs' names: drivers and readers, in the order of the flow (every reader reads
# what a driver, or one before it, says), and of each its module, what it is given as the rig, and its files' folder.
declare -A module_of rig_of folder_of
drivers=() readers=()
read_programs() {  # RIG
  local name module sensors folder file=$1 lines
  [ -f "$file" ] || file=${1%#*}
  lines=$("$bin/check_rig" "$1" --programs) || exit 1
  while IFS=$'\t' read -r name module sensors folder; do
    module_of[$name]=$module
    folder_of[$name]=$folder
    if [ "$sensors" = - ]; then rig_of[$name]=$1; else rig_of[$name]=$file#$sensors; fi
    case "$module" in *_driver) drivers+=("$name") ;; *) readers+=("$name") ;; esac
  done <<<"$lines"
}
folders() { printf '%s\n' "${folder_of[@]}" | sort -u; }  # each once; their names have no spaces
has_several_sensors() { [ ${#drivers[@]} -gt 2 ]; }  # after read_programs

fail() {  # MESSAGE [STATUS]
  echo "$(basename "$0"): $1" >&2
  exit "${2:-1}"
}

require_programs() {
  [ -x "$bin/check_rig" ] || fail "voqcal is not built yet: $how_to_build"
}

is_running() {  # SESSION: its supervisor answers; one that was killed leaves socket and log behind
  [ -S "$1/supervisor.sock" ] && supervisorctl -c "$1/supervisor.conf" pid >/dev/null 2>&1
}

# Processes of a session whose supervisor was killed: they go on by themselves. Their numbers, those that the
# supervisor wrote down, if they are still of this session: they are told its folder, a pair's in it, or the recording.
orphans_of() {  # SESSION
  local pid arg
  [ -f "$1/supervisord.log" ] && ! is_running "$1" || return 0
  for pid in $(sed -n "s/.* spawned: '.*' with pid \([0-9]*\)$/\1/p" "$1/supervisord.log"); do
    [ -r "/proc/$pid/cmdline" ] || continue
    while IFS= read -r -d '' arg; do
      if [[ "$arg" = "$1" ]] || { [ "${arg%/*}" = "$1" ] && { [ -d "$arg" ] || [[ "${arg##*/}" = raw*.lcm ]]; }; }; then
        echo "$pid"
        break
      fi
    done <"/proc/$pid/cmdline" || true
  done
}

# The session's folder, absolute: DIR, or logs/NAME-OF-THE-RIG below the working directory, or, without
# either, the one session that runs below logs/.
session_folder() {  # DIR RIG
  local dir=$1 rig=$2 running
  if [ -z "$dir" ] && [ -n "$rig" ]; then
    dir=logs/$("$bin/check_rig" "$rig" --name) || exit 1
  elif [ -z "$dir" ]; then
    shopt -s nullglob
    running=(logs/*/supervisor.sock)
    [ ${#running[@]} -eq 1 ] || fail "${#running[@]} sessions run below logs/: name the rig or --session"
    dir=$(dirname "${running[0]}")
  fi
  realpath --canonicalize-missing -- "$dir"
}
