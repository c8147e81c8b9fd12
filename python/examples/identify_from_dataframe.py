# SPDX-License-Identifier: Apache-2.0
"""Identifies a machine from tables in memory: one table a sensor, a pandas.DataFrame or a dictionary of columns."""

import os
import subprocess
import sys
import tempfile

import numpy as np

import kinfer

program = os.environ.get("KINFER_PROGRAM", "kinfer")
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([program, "simulate", "robot6", "--grade", "noise", "--out", folder, "--quiet"], check=True)
    with open(os.path.join(folder, "imu.csv")) as file:
        header = file.readline().strip().split(",")
    values = np.genfromtxt(os.path.join(folder, "imu.csv"), delimiter=",", skip_header=1)

column = {name.split("[")[0]: values[:, k] for k, name in enumerate(header)}
sensors = sorted({name.rsplit("_", 1)[0] for name in column if name.endswith("_gx")})
tables = {
    sensor: {"t": column["t"], **{a: column[f"{sensor}_{a}"] for a in ("ax", "ay", "az", "gx", "gy", "gz")}}
    for sensor in sensors
}
try:
    import pandas  # type: ignore[import]

    data = {sensor: pandas.DataFrame(table) for sensor, table in tables.items()}
except ImportError:  # pandas is not needed
    data = tables

machine = kinfer.identify(data, progress=lambda stage, fraction: None)
print(machine.verdict)
for joint in machine.joints:
    print(f"  {joint['parent']} - {joint['child']}: {joint['type']}")
quaternions = kinfer.orient(data)
print("orientations:", {sensor: q.shape for sensor, q in quaternions.items()})
sys.exit(0 if machine.use and len(machine.joints) == len(sensors) - 1 else 1)
