#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_each_source.sh BUILD: every source and every header of src/ is complete by itself. In batches and behind a precompiled
# header of ours a missing #include goes unseen. BUILD has compile_commands.json by clang, one entry a source (KINFER_UNITY=OFF,
# CMAKE_DISABLE_PRECOMPILE_HEADERS=ON). What is precompiled here are headers of others alone: a file takes a second instead of four.
set -euo pipefail
commands=$(realpath "$1")/compile_commands.json
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# One line a source: its file, then its options without output, levels of optimisation and warnings.
perl -MJSON::PP -0777 -ne '
  for my $entry (@{decode_json($_)}) {
    my $options = $entry->{command};
    $options =~ s/^.*?\bclang\+\+\S*//;
    $options =~ s/\s-o\s+\S+//;
    $options =~ s/\s-c\s+\S+\s*$//;
    next if $options =~ /\s-mavx/;  # kernels: compiled alone and without precompiled headers in every build
    $options =~ s/\s-Xclang\s+\S+//g;
    $options =~ s/\s-(O|g|W|f|m)\S*//g;
    print "$entry->{file}\t$options\n" if $entry->{file} =~ m{/(src|tests|studies)/};
  }' "$commands" | sort -u >"$work/sources"
[ -s "$work/sources" ] || { echo "no sources in $commands" >&2; exit 1; }

common=$(cut -f2 "$work/sources" | grep -oE -- '-(I|isystem )[^ ]+' | sort -u | xargs)
cat >"$work/others.hpp" <<'HEADERS'
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <tl/expected.hpp>
HEADERS
clang++ -std=c++20 -x c++-header $common "$work/others.hpp" -o "$work/others.pch"

check() {  # FILE OPTIONS: its complaint, if it has one
  eval clang++ -std=c++20 -w -fsyntax-only -include-pch "$WORK/others.pch" $2 -x c++ "$1" 2>&1 || echo "$1"
}
export -f check
export WORK=$work

# It sees what it is meant to see.
example=$work/example.cpp
options=$(head -1 "$work/sources" | cut -f2)
echo 'kinfer::Vec3 v;' >"$example"
[ -n "$(check "$example" "$options")" ] || { echo "not seen: a missing #include"; exit 1; }
echo '#include "kinfer/geometry/rotation.hpp"' | cat - "$example" >"$work/whole.cpp"
[ -z "$(check "$work/whole.cpp" "$options")" ] || { echo "refused: a source that is complete"; exit 1; }

{
  cat "$work/sources"
  # A header whose source has its name is that source's first line.
  git ls-files 'src/*.hpp' | while read -r header; do [ -e "${header%.hpp}.cpp" ] || printf '%s\t%s\n' "$PWD/$header" "$common"; done
} | tr '\t\n' '\0\0' | xargs -0 -P "$(nproc)" -n 2 bash -c 'check "$0" "$1"' | tee "$work/complaints"
[ ! -s "$work/complaints" ]
