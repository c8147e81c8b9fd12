#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every relative link in the Markdown files leads to a file.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
status=0
while IFS=: read -r file link; do
  target=${link%%#*}
  [ -z "$target" ] && continue
  [ -e "$(dirname "$file")/$target" ] || { echo "$file: broken link $target"; status=1; }
done < <(find . -name '*.md' -not -path './build/*' -not -path '*/node_modules/*' -print0 | xargs -0 grep -oHE '\]\([^)]+\)' | sed -E 's/\]\(//; s/\)$//' | grep -vE ':https?://')
exit $status
