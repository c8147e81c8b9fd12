#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Every relative link in the Markdown files leads to an existing file, and its #anchor to a heading of that file. A link
# has a text: [](…) is a C++ lambda.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
status=0

anchors_of() {  # FILE: its headings as GitHub writes them into addresses
  sed -nE 's/^#+ //p' "$1" | tr '[:upper:]' '[:lower:]' | sed -E 's/[^a-z0-9 _-]//g; s/ /-/g'
}

while IFS=: read -r file link; do
  target=${link%%#*} anchor=
  case $link in *#*) anchor=${link#*#} ;; esac
  path=$file
  [ -z "$target" ] || path=$(dirname "$file")/$target
  if [ ! -e "$path" ]; then
    echo "$file: broken link $link"; status=1
  elif [ -n "$anchor" ] && ! anchors_of "$path" | grep -xF -- "$anchor" >/dev/null; then
    echo "$file: no such heading $link"; status=1
  fi
done < <(find . -name '*.md' -not -path './build*' -not -path '*/node_modules/*' -print0 |
  xargs -0 grep -oHE '[^[]\]\([^)]+\)' | sed -E 's/.\]\(//; s/\)$//' | grep -vE ':https?://')
exit $status
