#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_source_tarball.sh BUNDLE.cpp OUT.tar.gz: the committed sources with the report's bundle, so that neither npm nor a
# network is needed to compile them. The same bytes for the same commit.
set -euo pipefail
bundle=$1 out=$2
version=$(sed -n 's/^project(kinfer VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$(dirname "$out")"
git archive --prefix="kinfer-$version/" HEAD | tar -x -C "$work"
cp "$bundle" "$work/kinfer-$version/web/bundle.cpp"
tar -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mode=go=rX,u+rw --mtime="@$(git log -1 --format=%ct)" \
  -cf - "kinfer-$version" | gzip -9n >"$out"
