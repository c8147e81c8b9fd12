#!/usr/bin/env bash
# The folder rule of docs/design.md: which folder may include which, read off the include lines.
set -euo pipefail
cd "${1:-.}/src/kinfer"
declare -A may=(
  [base]="" [linalg]="base" [geometry]="base linalg" [measurement]="base linalg geometry"
  [kinematics]="base linalg geometry" [evidence]="base linalg geometry kinematics" [inertial]="base linalg geometry measurement"
  [search]="base linalg"
  [estimate]="base linalg geometry measurement kinematics evidence inertial search"
  [identify]="base linalg geometry measurement kinematics evidence inertial search estimate"
  [calibrate]="base linalg geometry measurement kinematics evidence search estimate"
  [simulate]="base linalg geometry measurement kinematics"
  [io]="base linalg geometry measurement kinematics evidence"
  [report]="base linalg geometry kinematics evidence io"
  [cli]="base linalg geometry measurement kinematics evidence inertial search estimate identify calibrate simulate io report cli"
)
status=0
while IFS=: read -r file included; do
  from=${file%%/*}
  to=$(sed -E 's|.*"kinfer/([a-z_]+)/.*|\1|' <<<"$included")
  [ "$from" = "$to" ] && continue
  case " ${may[$from]-none} " in
    *" $to "*) ;;
    *) echo "src/kinfer/$file: $from may not include $to"; status=1 ;;
  esac
done < <(grep -rHoE '#include "kinfer/[a-z_]+/[^"]*"' --include='*.?pp' . | sed 's|^\./||')
if grep -rnE '<Eigen/(SVD|Eigenvalues|QR|Cholesky|LU|Dense|Sparse)' --include='*.?pp' . | grep -v '^\./linalg/'; then
  echo "decompositions belong into linalg (compile time)"; status=1
fi
exit $status
