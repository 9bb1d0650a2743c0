# in_chroot.sh ROOT SHARED COMMAND...: the part of tools/on_debian that runs in namespaces of its own.
set -euo pipefail
root=$1 shared=$2
shift 2
mount -t proc proc "$root/proc"
mount --rbind /sys "$root/sys"
mount --rbind /dev "$root/dev"
mount -t tmpfs -o mode=1777 tmpfs "$root/dev/shm"
[ -z "$shared" ] || mount --bind -o ro "$shared" "$root/root/shared"
certificates=()
[ ! -r "$root/root/host_certificates.crt" ] || certificates=(NODE_EXTRA_CA_CERTS=/root/host_certificates.crt)
# Nothing of this host's settings but its proxies.
exec env --ignore-environment HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM="${TERM:-dumb}" LANG=C.UTF-8 \
  ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} "${certificates[@]}" \
  chroot "$root" sh -c 'cd /root/voqcal && exec "$@"' sh "$@"
