#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_reproducible.sh TARBALL OUT: the packages in OUT are built a second time, in a folder of another name and depth; the
# same bytes are expected.
set -euo pipefail
tarball=$1 first=$(realpath "$2")
again=$(mktemp -d)/elsewhere/deeper
trap 'rm -rf "${again%/elsewhere/deeper}"' EXIT
bash "$(dirname "${BASH_SOURCE[0]}")/build_debian_packages.sh" "$tarball" "$again"
cd "$again"
sha256sum ./*.deb | (cd "$first" && sha256sum -c)
