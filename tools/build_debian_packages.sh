#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build_debian_packages.sh TARBALL OUT: Debian's packages from a source tarball, in a new folder below OUT.
set -euo pipefail
tarball=$(realpath "$1") out=$2
mkdir -p "$out/source"
tar -xzf "$tarball" -C "$out/source"
cd "$out"/source/kinfer-*
# A cache of objects may hold those of another folder; dates in archives are those of the changelog (SOURCE_DATE_EPOCH).
log=../build.log
env -u CC -u CXX -u CXXFLAGS -u LDFLAGS CCACHE_DISABLE=1 DEB_BUILD_OPTIONS="parallel=$(nproc)" \
  dpkg-buildpackage -b -us -uc >"$log" 2>&1 || { tail -40 "$log" >&2; exit 1; }
mv ../*.deb ../*.changes ../*.buildinfo ../build.log "$(cd ../.. && pwd)"
