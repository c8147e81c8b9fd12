#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs inside an empty Debian, beside the packages: installs, uses and purges them.
set -euo pipefail
cd "$(dirname "$0")"
fail() { echo "in_empty_debian: $*" >&2; exit 1; }
install() { apt-get install -y -q "$@" >/root/apt.log 2>&1 || { tail -5 /root/apt.log >&2; fail "apt-get install $*"; }; }

# What apt and dpkg write for themselves is no trace of a package.
listing() { find / -xdev \( -path /proc -o -path /dev -o -path /root -o -path /tmp -o -path /var/lib/apt -o -path /var/lib/dpkg \
  -o -path /var/cache -o -path /var/log \) -prune -o -print | sort; }

apt-get update -q >/dev/null
# Systems have these already, or get them with their own packages: they are not what is looked for.
install --no-install-recommends g++ cmake ninja-build pkgconf python3 man-db bash-completion
listing >/root/before

echo "== without MuJoCo"
install --no-install-recommends ./kinfer_*.deb
code=0
kinfer simulate excavator --out /root/none 2>/root/said || code=$?
[ $code = 2 ] && grep -q 'MuJoCo is needed' /root/said || fail "exit code $code, $(cat /root/said)"
cat /root/said
kinfer simulate-poses --help >/dev/null
apt-get purge -y -q kinfer >/dev/null 2>&1
apt-get autoremove --purge -y -q >/dev/null 2>&1

echo "== from the package to a report"
start=$(date +%s)
install ./kinfer_*.deb
(cd /root && kinfer demo --quiet)
[ -s /root/kinfer-demo/excavator/report.html ] && [ -s /root/kinfer-demo/calibration/report.html ] || fail "no report"
echo "two commands, $(($(date +%s) - start)) s"

echo "== verbs"
(
  cd /root
  kinfer simulate crane --out drive --quiet
  kinfer identify drive/imu.csv --out chain --quiet
  kinfer calibrate --robot kinfer-demo/data/robot.toml --data kinfer-demo/data/poses.csv --out calibration --quiet
)
man -w kinfer-identify >/dev/null
[ -s /usr/share/bash-completion/completions/kinfer ] || fail "no completion"

echo "== C++"
install --no-install-recommends ./libkinfer-dev_*.deb
cmake -S . -B /root/user -G Ninja >/dev/null
cmake --build /root/user >/dev/null
/root/user/kinfer_user
c++ -std=c++20 user.cpp -o /root/by_pkg_config $(pkg-config --cflags --libs kinfer)
/root/by_pkg_config

echo "== Python"
install --no-install-recommends ./python3-kinfer_*.deb ./kinfer-doc_*.deb
python3 - <<'PYTHON'
import time
start = time.perf_counter()
import kinfer
print(f"import kinfer {kinfer.__version__}: {1e3 * (time.perf_counter() - start):.0f} ms")
PYTHON
(cd /root && KINFER_SOURCE_DIR=/usr/share/doc/kinfer python3 /usr/share/doc/kinfer/examples/python/calibrate_from_arrays.py >/dev/null)

for page in index.html docs/users/first-steps.html site.css search_index.js; do test -s "/usr/share/doc/kinfer/html/$page"; done

echo "== purge"
apt-get purge -y -q kinfer libkinfer-dev python3-kinfer kinfer-doc >/dev/null 2>&1
apt-get autoremove --purge -y -q >/dev/null 2>&1
listing >/root/after
diff /root/before /root/after >/root/left || { cat /root/left >&2; fail "traces are left"; }
