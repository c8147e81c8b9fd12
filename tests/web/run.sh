#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# NODE TEST: runs the browser tests, or skips them (exit code 77) if KINFER_SKIP_BROWSER=1.
if [ "${KINFER_SKIP_BROWSER:-0}" = 1 ]; then
  echo "browser tests skipped: KINFER_SKIP_BROWSER=1"
  exit 77
fi
exec "$1" --test "$2"
