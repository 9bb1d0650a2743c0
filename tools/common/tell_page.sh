#!/usr/bin/env bash
# tell_page.sh FILE: where a session's page is (FILE: its dashboard_url.txt), for who sits at the terminal; for a phone as a
# QR code, since nobody types 64 hexadecimal digits.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/rig_scripts.sh"

mapfile -t addresses <"$1"
echo "the page: ${addresses[0]}"
for other in "${addresses[@]:1}"; do echo "      or: $other"; done
if [[ "${addresses[0]}" =~ ^http://(127\.|localhost|\[::1\]) ]]; then
  echo "no QR code: this host alone reaches it; 'dashboard: {address: 0.0.0.0}' in the rig file lets a phone in"
elif ! command -v qrencode >/dev/null; then
  echo "no QR code of it for a phone: qrencode is not installed ($(how_to_install qrencode))"
else
  qrencode --type ANSIUTF8 --level L --margin 2 "${addresses[0]}"
fi
