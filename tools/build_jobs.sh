#!/bin/sh
# Prints how many compilers may run at once: one per processor, but at least about 2 GiB of free memory for each.
set -eu

processors=$(nproc)
gibibyte=1048576 # in KiB
memory=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || true)
limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || true)
case "$limit" in
  '' | max | *[!0-9]*) ;;
  *) limit=$((limit / 1024)); [ "${memory:-$limit}" -le "$limit" ] || memory=$limit ;;
esac

jobs=$processors
if [ -n "${memory:-}" ]; then
  by_memory=$((memory / (2 * gibibyte)))
  [ "$jobs" -le "$by_memory" ] || jobs=$by_memory
fi
[ "$jobs" -ge 1 ] || jobs=1
echo "$jobs"
