#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The rules of docs/development/design.md, read off the include lines of src/kinfer: which room may include which, and no
# cycle among files (a .hpp and its .cpp count as one) nor among folders, sub-rooms included.
set -euo pipefail
cd "${1:-.}/src/kinfer"
declare -A may=(
  [base]="" [linalg]="base" [geometry]="base linalg" [measurement]="base linalg geometry"
  [kinematics]="base linalg geometry" [evidence]="base linalg geometry measurement kinematics" [inertial]="base linalg geometry measurement"
  [search]="base linalg"
  [estimate]="base linalg geometry measurement kinematics evidence inertial search"
  [identify]="base linalg geometry measurement kinematics evidence inertial search estimate"
  [calibrate]="base linalg geometry measurement kinematics evidence search estimate"
  [plan]="base linalg geometry measurement kinematics evidence search estimate calibrate"
  [deploy]="base linalg geometry measurement kinematics evidence search estimate calibrate plan motion"
  [motion]="base linalg geometry kinematics evidence"
  [track]="base linalg geometry measurement kinematics evidence inertial estimate"
  [simulate]="base linalg geometry measurement kinematics"
  [fleet]="base linalg geometry measurement kinematics evidence search estimate inertial"
  [words]="base linalg geometry measurement kinematics evidence inertial"
  [io]="base linalg geometry measurement kinematics evidence words"
  [report]="base linalg geometry measurement kinematics evidence words io"
  [cli]="base linalg geometry measurement kinematics evidence inertial search estimate identify calibrate plan deploy motion track fleet simulate words io report cli"
)
status=0
edges=$(grep -rHoE '#include "kinfer/[^"]*"' --include='*.?pp' . |
  sed -E 's|^\./||; s|\.[ch]pp:#include "kinfer/| |; s|\.hpp"$||' | sort -u)

while read -r from to; do
  room=${from%%/*} used=${to%%/*}
  [ "$room" = "$used" ] && continue
  case " ${may[$room]-none} " in
    *" $used "*) ;;
    *) echo "src/kinfer/$from: $room may not include $used ($to)"; status=1 ;;
  esac
done <<<"$edges"

# tsort prints each member of a cycle on standard error.
no_cycles() {  # WHAT: pairs "user used" on standard input
  local loops
  if ! loops=$(tsort 2>&1 >/dev/null) || [ -n "$loops" ]; then
    echo "cycle of $1:"; sed 's/^tsort: //' <<<"$loops"; status=1
  fi
}
no_cycles files < <(awk '$1 != $2' <<<"$edges")
no_cycles folders < <(awk '{ a = $1; b = $2; sub(/\/[^\/]*$/, "", a); sub(/\/[^\/]*$/, "", b); if (a != b) print a, b }' <<<"$edges" | sort -u)

if grep -rnE '<Eigen/(SVD|Eigenvalues|QR|Cholesky|LU|Dense|Sparse)' --include='*.?pp' . | grep -v '^\./linalg/'; then
  echo "decompositions belong into linalg (compile time)"; status=1
fi
exit $status
