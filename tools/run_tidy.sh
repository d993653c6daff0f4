#!/bin/bash
# clang-tidy over the library and the program: run_tidy.sh BUILD_TREE JOBS [FILE...]
set -euo pipefail

build=$1
jobs=$2
shift 2
command -v clang-tidy >/dev/null || { echo "clang-tidy is not installed (Debian package clang-tidy)." >&2; exit 1; }
[ $# -gt 0 ] || mapfile -t files < <(find src apps -name '*.cpp' | sort)
[ $# -eq 0 ] || files=("$@")
printf '%s\n' "${files[@]}" | xargs --max-procs="$jobs" --max-args=1 clang-tidy --quiet -p "$build" --extra-arg=-Wno-unknown-warning-option
