#!/bin/sh
# in_namespace.sh with_route|without_route TEST: runs TEST's cases for that network in a new network
# namespace, as root or, where the kernel lets users have namespaces, as anyone.
set -eu
route=$1
test=$2
if [ "$(id -u)" -eq 0 ]; then new="unshare -n"; else new="unshare -rn"; fi
if [ "$route" = without_route ]; then
  exec $new "$test" --gtest_filter='UdpmWithoutRoute.*'
fi
exec $new sh -c '
  set -eu
  ip link set lo up
  ip link set lo multicast on
  ip route add 224.0.0.0/4 dev lo
  exec "$1" --gtest_filter="Udpm.*"' sh "$test"
