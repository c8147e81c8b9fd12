# SPDX-License-Identifier: Apache-2.0
"""Calibrates a robot from arrays: what a script beside a laser tracker would do."""

import os
import sys

import numpy as np

import kinfer

source = os.environ.get("KINFER_SOURCE_DIR", ".")
robot = kinfer.Robot.load(os.path.join(source, "examples/robot6/robot.toml"))

# A robot that differs from its data sheet, and stands somewhere: here simulated by the nominal model with wrong zeros.
rng = np.random.default_rng(1)
lower, upper = 0.7 * robot.limits.T
joints = rng.uniform(lower, upper, (60, robot.dof))
wrong_zeros = np.radians([0.0, 0.05, -0.08, 0.03, 0.1, 0.0])
positions = robot.forward(joints + wrong_zeros)[:, :3, 3] + rng.normal(0.0, 2e-5, (60, 3))

calibration = kinfer.calibrate(robot, joints, positions=positions, sd=2e-5, model="geometry")
print(calibration.verdict)
print(f"held-out error: {1e3 * calibration.rms_before:.3f} mm before, {1e3 * calibration.rms_after:.3f} mm after")
for parameter in calibration.parameters:
    if parameter["name"].startswith("theta") and parameter["identifiable"]:
        change = np.degrees(parameter["value"] - parameter["nominal"])
        print(f"  {parameter['name']}: {change:+.4f} deg, sd {np.degrees(parameter['sd']):.4f}")

# The joint targets that put the real tool where the program wants it.
corrected = kinfer.compensate(calibration.robot, robot, joints[:5], frames="robot")
print(f"largest correction: {np.degrees(np.abs(corrected['joints'] - joints[:5]).max()):.3f} deg")
sys.exit(0 if calibration.use and calibration.rms_after < 0.3 * calibration.rms_before else 1)
