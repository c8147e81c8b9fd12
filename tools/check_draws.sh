#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Random numbers are drawn in an order that the language fixes (tools/check_draws.pl), and the check sees what it is meant to see.
set -euo pipefail
cd "${1:-.}"
find src tests studies bench examples -name '*.?pp' -print0 | xargs -0 perl tools/check_draws.pl

example=$(mktemp)
trap 'rm -f "$example"' EXIT
refused() { echo "void f(Rng& rng) { $1; }" >"$example"; ! perl tools/check_draws.pl "$example" >/dev/null || { echo "not seen: $1"; exit 1; }; }
allowed() { echo "void f(Rng& rng) { $1; }" >"$example"; perl tools/check_draws.pl "$example" >/dev/null || { echo "refused: $1"; exit 1; }; }
refused 'const Vec3 v(rng.normal(), rng.normal(), rng.normal())'
refused 'x = a * rng.normal() + b * rng.uniform(0, 1)'
refused 'g(any(rng), any(rng))'
refused 'const auto any = [&] { return rng.normal(); }; g(any(), any())'
allowed 'const double x = rng.normal(), y = rng.normal()'
allowed 'Vec3 v{rng.normal(), rng.normal(), rng.normal()}'
allowed 'g(any(rng), rng)'
allowed 'if (rng.uniform() < 0.5) x = rng.normal()'
allowed 'a[rng.index(3)] = b[rng.index(3)]'
