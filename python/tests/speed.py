# SPDX-License-Identifier: Apache-2.0
"""Time to import the package and to compute 100 000 tool poses: PYTHONPATH=build/python python3 python/tests/speed.py"""

import os
import subprocess
import sys
import time
from typing import Callable

import numpy as np

import kinfer


def best_milliseconds(work: Callable[[], object], times: int) -> float:
    best = float("inf")
    for _ in range(times):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return 1e3 * best


def run(code: str) -> None:
    subprocess.run([sys.executable, "-c", code], check=True)


source = os.environ.get("KINFER_SOURCE_DIR", ".")
robot = kinfer.Robot.load(os.path.join(source, "examples/robot6/robot.toml"))
joints = np.random.default_rng(1).uniform(-2, 2, (100_000, robot.dof))
empty = best_milliseconds(lambda: run(""), 5)
print(f"import kinfer: {best_milliseconds(lambda: run('import kinfer'), 5) - empty:.1f} ms")
print(f"import numpy, kinfer: {best_milliseconds(lambda: run('import numpy, kinfer'), 5) - empty:.1f} ms")
for threads in (1, 2):
    milliseconds = best_milliseconds(lambda: robot.forward(joints, threads=threads), 15)
    print(f"forward of 100 000 poses, {threads} thread{'s' if threads > 1 else ''}: {milliseconds:.1f} ms")
