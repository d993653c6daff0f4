#!/bin/bash
# Makes sure that what the build needs is there. Quick and silent when it is; otherwise installs the missing packages
# with apt-get (as root, or through sudo), or says in one sentence which they are.
#   --install=yes   install what is missing (default)
#   --install=no    only check; a missing package is an error
set -euo pipefail

install=yes
for argument in "$@"; do
  case "$argument" in
    --install=yes | --install=no) install=${argument#--install=} ;;
    *) echo "install_dependencies.sh: unknown argument '$argument'; it takes --install=yes or --install=no." >&2; exit 2 ;;
  esac
done

# Tools count as there when their command is, wherever it came from: package:command.
tools=(g++:g++ cmake:cmake ninja-build:ninja pkg-config:pkg-config python3:python3)
libraries=(libtbb-dev libhwy-dev libassimp-dev libcli11-dev libfmt-dev nlohmann-json3-dev libpng-dev libgtest-dev
  libbenchmark-dev)
# A rival to measure against; everything else works without it.
optional=(libembree-dev)

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

missing=()
missing_tools=()
for tool in "${tools[@]}"; do
  command -v "${tool#*:}" >/dev/null || { missing+=("${tool%%:*}"); missing_tools+=("${tool#*:}"); }
done

if ! command -v dpkg-query >/dev/null; then
  if [ ${#missing_tools[@]} -gt 0 ]; then
    echo "These commands are missing, and this is no Debian system to install them on: ${missing_tools[*]}." >&2
    exit 1
  fi
  exit 0 # CMake names the libraries it can't find
fi

for package in "${libraries[@]}"; do is_installed "$package" || missing+=("$package"); done
missing_optional=()
for package in "${optional[@]}"; do is_installed "$package" || missing_optional+=("$package"); done

as_root=()
may_install=yes
if [ "$install" = no ]; then
  may_install=no
elif [ "$(id -u)" -ne 0 ]; then
  if command -v sudo >/dev/null; then as_root=(sudo); else may_install=no; fi
fi

# With Debian's lists as they are; with fresh ones when they are absent or point at packages that are gone.
apt_install() {
  local get=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o=Dpkg::Use-Pty=0)
  local packages=(install --yes --no-install-recommends "$@")
  if apt-get --simulate "${packages[@]}" >/dev/null 2>&1 && "${get[@]}" "${packages[@]}" >/dev/null; then return 0; fi
  "${get[@]}" update && "${get[@]}" "${packages[@]}" >/dev/null
}

if [ ${#missing[@]} -gt 0 ]; then
  if [ "$may_install" = no ]; then
    echo "These packages are missing: ${missing[*]}. Install them (as root: apt-get install ${missing[*]}) and try again." >&2
    exit 1
  fi
  echo "Installing ${missing[*]} ..."
  if ! apt_install "${missing[@]}"; then
    echo "apt-get could not install all of these packages: ${missing[*]}. Its own words are above." >&2
    exit 1
  fi
fi

if [ ${#missing_optional[@]} -gt 0 ]; then
  # Never asks for a password for something that is not needed, unless one was asked for just now.
  if [ "$may_install" = yes ] && { [ "$(id -u)" -eq 0 ] || [ ${#missing[@]} -gt 0 ]; } &&
    apt_install "${missing_optional[@]}" 2>/dev/null; then
    echo "Installed ${missing_optional[*]} (optional, to measure against)."
  else
    echo "Note: ${missing_optional[*]} is not installed; everything works without it, except --rivals embree."
  fi
fi
