#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_debian_packages.sh FOLDER [BASE]: the packages of FOLDER are what they should be, and work in an empty Debian: they
# are installed, used and purged there. As root; fetches Debian's minimal system unless BASE holds one.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd) folder=$(realpath "$1") base=${2:-}
work=$(mktemp -d)
# Mounts live in a name space of their own and are gone before anything is removed; the second look makes sure of it.
trap '! grep -q " $work" /proc/mounts && rm -rf --one-file-system "$work"' EXIT

fail() { echo "check_debian_packages: $*" >&2; exit 1; }

largest_program=6000000 largest_package=3000000 most_dependencies=12  # [bytes], [bytes]

one_package() {  # NAME: its file
  local files=("$folder/$1"_*.deb)
  [ ${#files[@]} = 1 ] && [ -f "${files[0]}" ] || fail "one package $1 is expected in $folder"
  echo "${files[0]}"
}

check_file() {
  local deb program dependencies
  deb=$(one_package kinfer)
  dpkg-deb -x "$deb" "$work/unpacked"
  program=$work/unpacked/usr/bin/kinfer
  dependencies=$(dpkg-deb -f "$deb" Depends | tr ',' '\n' | wc -l)
  echo "program $(stat -c %s "$program") bytes, package $(stat -c %s "$deb") bytes, $dependencies dependencies"
  [ "$(stat -c %s "$program")" -le $largest_program ] || fail "the program is larger than $largest_program bytes"
  [ "$(stat -c %s "$deb")" -le $largest_package ] || fail "the package is larger than $largest_package bytes"
  [ "$dependencies" -le $most_dependencies ] || fail "more than $most_dependencies dependencies"
  if dpkg-deb -f "$deb" Depends | grep -q mujoco; then fail "MuJoCo is a dependency"; fi
  local header
  header=$(readelf -hldW --dyn-syms "$program")  # whole: grep -q would end a pipe too early
  grep -q 'Type: *DYN' <<<"$header" || fail "the program is not position-independent"
  grep -q GNU_RELRO <<<"$header" || fail "no RELRO"
  grep -qE 'BIND_NOW|FLAGS_1.*NOW' <<<"$header" || fail "RELRO is not full"
  grep -q __stack_chk_fail <<<"$header" || fail "no stack protector"
  grep -q '_chk@' <<<"$header" || fail "no fortified function"
  local text
  for deb in "$folder"/*.deb; do
    dpkg-deb -x "$deb" "$work/all"
  done
  text=$(grep -rlaF "$folder" "$work/all" || true)
  [ -z "$text" ] || fail "the folder of the build is in $text"
}

empty_debian() {
  local root=$work/root
  if [ -n "$base" ]; then cp -a "$base" "$root"; else debootstrap --variant=minbase bookworm "$root" >/dev/null; fi
  # The machine's own way to the archive: mirror, proxy, certificates.
  local file
  for file in /etc/resolv.conf /etc/hosts /etc/apt/apt.conf.d/. /etc/apt/sources.list.d/debian.sources \
    /etc/ssl/certs/ca-certificates.crt /usr/local/share/ca-certificates/.; do
    [ -e "$file" ] || continue
    mkdir -p "$root$(dirname "$file")"
    cp -aL "$file" "$root$(dirname "$file")/" 2>/dev/null || cp -L "$file" "$root$file"
  done
  [ ! -e "$root/etc/apt/sources.list.d/debian.sources" ] || : >"$root/etc/apt/sources.list"
  mkdir -p "$root/root/check"
  cp "$folder"/*.deb "$here/package/in_empty_debian.sh" "$here/package/CMakeLists.txt" "$here/package/user.cpp" "$root/root/check/"
  local settings
  mapfile -t settings < <(env | grep -iE '^(https?_proxy|no_proxy)=' || true)
  ROOT=$root unshare -m bash -c 'mount --bind /proc "$ROOT/proc" && mount --bind /dev "$ROOT/dev" && exec chroot "$ROOT" \
    /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@" \
    bash /root/check/in_empty_debian.sh' unshare "${settings[@]}"
}

check_file
empty_debian
[ -c /dev/null ] || fail "/dev/null is no device any more"
echo "packages work in an empty Debian, and leave no trace"
