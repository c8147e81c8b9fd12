#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# check_study.sh PROGRAM OUT: a short run of the study of paper 2 gives the same tables on one thread and on two, except
# for columns of times.
set -euo pipefail
program=$1 out=$2
rm -rf "$out"
KINFER_DATA='' "$program" paper2 "$out/one" 1 1 >/dev/null 2>&1
KINFER_DATA='' "$program" paper2 "$out/two" 2 1 >/dev/null 2>&1
without_times() {  # TABLE: the columns whose header is not in seconds
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) keep[i] = ($i !~ /\[s\]/) }
           { line = ""; for (i = 1; i <= NF; ++i) if (keep[i]) line = line "," $i; print line }' "$1"
}
for table in "$out"/one/*.csv; do
  diff <(without_times "$table") <(without_times "$out/two/$(basename "$table")") ||
    { echo "$(basename "$table") depends on the number of threads"; exit 1; }
done
for figure in "$out"/one/*.svg; do cmp "$figure" "$out/two/$(basename "$figure")"; done
