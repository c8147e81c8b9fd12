#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# find_package(kinfer) works from an installed tree: installs BUILD into a temporary folder and builds a user's program.
set -euo pipefail
build=$1 source=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/package
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cmake --install "$build" --prefix "$place/kinfer" >/dev/null
cmake -S "$source" -B "$place/build" -G Ninja -DCMAKE_PREFIX_PATH="$place/kinfer" >/dev/null
cmake --build "$place/build" >/dev/null
"$place/build/kinfer_user"
"$place/kinfer/bin/kinfer" --version
