#!/usr/bin/env bash
# with_node.sh COMMAND...: runs it, or ends with 77 ("skipped" to ctest) where Node.js is not set up.
folder=$(cd "$(dirname "$0")/../../tools/node" && pwd)
command -v node >/dev/null || { echo "skipped: no Node.js (tools/setup installs it)"; exit 77; }
[ -d "$folder/node_modules" ] || { echo "skipped: no packages (tools/setup installs them)"; exit 77; }
exec "$@"
