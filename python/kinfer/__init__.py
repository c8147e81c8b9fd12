# SPDX-License-Identifier: Apache-2.0
"""From raw measurements to a proven kinematic model.

Arrays are in SI units: m, rad, s, m/s^2, rad/s. Errors of the data are InputError, a ValueError with one sentence.
"""

from kinfer._kinfer import (
    Calibration,
    Identification,
    InputError,
    PoseSet,
    Recording,
    Robot,
    TrackedRun,
    Tracker,
    __version__,
    calibrate,
    compensate,
    identify,
    orient,
    plan,
    read_log,
    read_poses,
    track,
)

__all__ = [
    "Calibration",
    "Identification",
    "InputError",
    "PoseSet",
    "Recording",
    "Robot",
    "TrackedRun",
    "Tracker",
    "__version__",
    "calibrate",
    "compensate",
    "identify",
    "orient",
    "plan",
    "read_log",
    "read_poses",
    "track",
]
