#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Time and peak memory of what is long, large or many, one row each: bash bench/large.sh ROW [SIZE], rows:
#   sweep [60]       calibrations, one at a time and on all cores: the ratio
#   overhead [500]   tasks that do nothing, in a sweep and as programs of their own: processor time of each
#   many [10000]     calibrations of 40 poses: processor time, memory of the sweep as it goes, merge
#   hour [3600]      seconds of six sensors: identify
#   poses [1000000]  calibrate
#   joints [40]      calibrate a robot with that many
#   follow [86400 [50]]  seconds of six sensors at that rate [Hz] through track: memory as it goes
# KINFER: the program; default build/bin/kinfer. Files go below ${TMPDIR:-/tmp} and are removed.
set -euo pipefail
home=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
kinfer=$(realpath "${KINFER:-$home/build/bin/kinfer}")
robot=$home/examples/robot6/robot.toml errors=$home/examples/robot6/errors.toml
row=${1:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# timed NAME COMMAND...: seconds by the clock, of the processors, and peak memory
timed() {
  local name=$1; shift
  /usr/bin/time -o time.txt -f "%e %U %S %M" "$@" >/dev/null
  read -r wall user system kilobytes <time.txt
  awk -v n="$name" -v w="$wall" -v u="$user" -v s="$system" -v k="$kilobytes" \
    'BEGIN { printf "%-40s %9.2f s  %9.2f s CPU  %8.0f MB\n", n, w, u + s, k / 1000 }'
}

# memory_of PROCESS EVERY: its resident memory in MB, until it ends
memory_of() {
  local resident
  while resident=$(awk '/VmRSS/ { print $2 }' "/proc/$1/status" 2>/dev/null) && [ -n "$resident" ]; do
    printf '%s ' $((resident / 1000)); sleep "$2"
  done
  echo MB
}

poses() { "$kinfer" simulate-poses --robot "$robot" --errors "$errors" --poses "$1" --lowest 0 --clearance 350 --out data --quiet; }

manifest() {  # COUNT: calibrations of the same poses
  echo key,verb,arguments
  for i in $(seq "$1"); do echo "t$i,calibrate,--robot data/robot.toml --data data/poses.csv"; done
}

case $row in
  sweep)
    poses 40; manifest "${2:-60}" >tasks.csv
    timed "one at a time" "$kinfer" sweep tasks.csv --out serial --workers 1 --quiet; serial=$wall
    timed "on all cores" "$kinfer" sweep tasks.csv --out all --quiet
    awk -v a="$serial" -v b="$wall" 'BEGIN { printf "ratio %.2f\n", a / b }' ;;
  overhead)
    n=${2:-500}
    printf 'q1[deg],q2[deg],q3[deg],q4[deg],q5[deg],q6[deg]\n10,-80,70,20,40,-30\n' >joints.csv
    { echo key,verb,arguments
      for i in $(seq "$n"); do echo "t$i,predict,--chain $robot --joints joints.csv -o {out}/poses.csv"; done; } >tasks.csv
    timed "$n tasks in a sweep" "$kinfer" sweep tasks.csv --out runs --workers 1 --quiet
    timed "$n programs" bash -c "for i in \$(seq $n); do '$kinfer' predict --chain '$robot' --joints joints.csv -o p.csv; done" ;;
  many)
    poses 40; manifest "${2:-10000}" >tasks.csv
    "$kinfer" sweep tasks.csv --out runs --pack --quiet & sweep=$!
    memory_of $sweep 30
    wait $sweep
    timed "merge" "$kinfer" merge runs --out fleet --quiet ;;
  hour)
    timed "simulate" "$kinfer" --limit-memory 0 simulate excavator-general --duration "${2:-3600}" --out drive --quiet
    timed "identify" "$kinfer" --limit-time 0 identify drive/imu.csv --out found --quiet || true ;;
  poses)
    poses "${2:-1000000}"
    timed "calibrate" "$kinfer" --limit-time 0 --limit-memory 0 calibrate --robot data/robot.toml --data data/poses.csv --out out --quiet || true ;;
  joints)
    { printf 'name = "long"\nconvention = "mdh"\nunits = { length = "mm", angle = "deg" }\n[instrument]\nsigma = 0.05\n'
      for i in $(seq "${2:-40}"); do
        printf '[[joint]]\ntype = "revolute"\na = %d\nalpha = %d\nd = %d\ntheta = 0\nlimits = [-90, 90]\n' \
          $((20 + i)) $((i % 2 ? 90 : -90)) $((10 * (i % 3)))
      done; } >robot.toml
    "$kinfer" simulate-poses --robot robot.toml --poses 400 --out data --quiet
    timed "calibrate" "$kinfer" --limit-time 0 calibrate --robot data/robot.toml --data data/poses.csv --out out --quiet || true ;;
  follow)
    "$kinfer" simulate excavator --rate "${3:-50}" --duration 120 --out drive --quiet
    "$kinfer" identify drive/imu.csv --out machine --quiet || true
    # The drive again and again, with the time going on.
    repeat='NR == 1 { print; next } { rest[++n] = substr($0, index($0, ",")); t[n] = $1 }
      END { period = t[n] + t[2] - t[1]
            for (base = 0; base < seconds; base += period)
              for (i = 1; i <= n && base + t[i] < seconds; ++i) printf "%.3f%s\n", base + t[i], rest[i] }'
    begin=$SECONDS
    "$kinfer" track machine - --quiet < <(awk -F, -v seconds="${2:-86400}" "$repeat" drive/imu.csv) >/dev/null &
    memory_of $! 10
    wait $! || true
    echo "$((SECONDS - begin)) s by the clock" ;;
  *) echo "usage: bash bench/large.sh sweep|overhead|many|hour|poses|joints|follow [SIZE]" >&2; exit 2 ;;
esac
