#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How late `kinfer track` is: latency.py KINFER MACHINE LOG [ROWS]. Writes one line of the log at a time, to standard
input and to a growing file, waits for the row that belongs to it, and counts the rows that come later."""
import os
import select
import subprocess
import sys
import tempfile
import time

PATIENCE = 2.0  # [s] after which a row counts as late


def measure(mode, program, machine, lines):
    file = tempfile.NamedTemporaryFile(suffix=".csv")
    source = ["-"] if mode == "standard input" else [file.name, "--follow"]
    run = subprocess.Popen([program, "track", machine, *source, "--quiet"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    sink = run.stdin if mode == "standard input" else file
    rows, late, times = -1, 0, []  # the first line of the output is its header
    for index, line in enumerate(lines):
        begin = time.monotonic()
        sink.write(line)
        sink.flush()
        if index == 0:
            continue
        while rows < index and select.select([run.stdout], [], [], PATIENCE)[0]:
            rows += os.read(run.stdout.fileno(), 1 << 16).count(b"\n")
        late = max(late, index - rows)
        times.append(1e3 * (time.monotonic() - begin))
    run.kill()
    run.wait()
    times.sort()
    print(f"{mode}: {len(times)} rows, at most {late} late, median {times[len(times) // 2]:.1f} ms, "
          f"99 %: {times[99 * len(times) // 100]:.1f} ms")


def main():
    program, machine, log = sys.argv[1:4]
    count = int(sys.argv[4]) if len(sys.argv) > 4 else 1000
    with open(log, "rb") as file:
        lines = [line for _, line in zip(range(count + 1), file)]
    for mode in ("standard input", "growing file"):
        measure(mode, program, machine, lines)


if __name__ == "__main__":
    main()
