# SPDX-License-Identifier: Apache-2.0
"""How often the standard deviations tell the truth: a robot with known zeros, measured and calibrated many times."""

import os
import sys

import numpy as np

import kinfer

source = os.environ.get("KINFER_SOURCE_DIR", ".")
robot = kinfer.Robot.load(os.path.join(source, "examples/robot6/robot.toml"))
noise = 2e-5  # [m] of the tracker, per axis
trials = 12
inside = total = 0
for trial in range(trials):
    rng = np.random.default_rng(trial)
    joints = rng.uniform(-1.5, 1.5, (40, robot.dof))
    zeros = rng.normal(0.0, np.radians(0.05), robot.dof)
    positions = robot.forward(joints + zeros)[:, :3, 3] + rng.normal(0.0, noise, (40, 3))
    free = ["theta2", "theta3", "theta4", "theta5"]
    calibration = kinfer.calibrate(robot, joints, positions=positions, sd=noise, model="geometry", seed=trial + 1)
    truth = {f"theta{k + 1}": zeros[k] for k in range(robot.dof)}
    for parameter in calibration.parameters:
        if parameter["name"] in free and parameter["identifiable"]:
            deviation = parameter["value"] - parameter["nominal"] - truth[parameter["name"]]
            inside += abs(deviation) < 1.96 * parameter["sd"]
            total += 1

coverage = inside / max(total, 1)
print(f"{inside} of {total} intervals of 95 % contain the truth ({100 * coverage:.0f} %)")
sys.exit(0 if total > 0 and coverage > 0.8 else 1)
