# SPDX-License-Identifier: Apache-2.0
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import kinfer

PROGRAM = os.environ["KINFER_PROGRAM"]
SOURCE = Path(os.environ["KINFER_SOURCE_DIR"])


@pytest.fixture(scope="session")
def program():
    def run(*arguments, code=0, cwd=None):
        done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)
        assert done.returncode == code, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def robot():
    return kinfer.Robot.load(SOURCE / "examples/robot6/robot.toml")


@pytest.fixture(scope="session")
def poses(tmp_path_factory, program):
    folder = tmp_path_factory.mktemp("poses")
    example = SOURCE / "examples/robot6"
    program("simulate-poses", "--robot", example / "robot.toml", "--errors", example / "errors.toml", "--out", folder)
    return folder


@pytest.fixture(scope="session")
def drive(tmp_path_factory, program):
    folder = tmp_path_factory.mktemp("drive")
    program("simulate", "robot6", "--grade", "noise", "--out", folder)
    return folder


@pytest.fixture
def measured(robot):
    rng = np.random.default_rng(3)
    joints = rng.uniform(-1.5, 1.5, (40, 6))
    zeros = np.radians([0, 0.05, -0.08, 0.03, 0.1, 0])
    return joints, robot.forward(joints + zeros)
