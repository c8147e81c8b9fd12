# SPDX-License-Identifier: Apache-2.0
import os
import signal
import threading
import time

import numpy as np
import pytest

import kinfer


def test_the_evidence_is_the_programs_byte_for_byte(poses, program, tmp_path):
    program("calibrate", "--robot", poses / "robot.toml", "--data", poses / "poses.csv", "--out", tmp_path / "program")
    robot = kinfer.Robot.load(poses / "robot.toml")
    calibration = kinfer.calibrate(robot, poses / "poses.csv")
    calibration.save(tmp_path / "python")
    for file in (tmp_path / "program").iterdir():
        if file.name != "run.json":  # when and where it ran
            assert (tmp_path / "python" / file.name).read_bytes() == file.read_bytes(), file.name
    assert calibration.evidence_json == (tmp_path / "program/evidence.json").read_text()
    assert calibration.use and calibration.usability == "use"
    assert calibration.evidence["verdict"] == calibration.verdict
    assert calibration.rms_after < 0.1 * calibration.rms_before


def test_a_urdf_is_written_back_as_the_program_does(poses, program, tmp_path):
    program("convert", poses / "robot.toml", "arm.urdf", cwd=tmp_path)
    arguments = ["--robot", tmp_path / "arm.urdf", "--tip-link", "link_J6", "--data", poses / "poses.csv"]
    program("calibrate", *arguments, "--offsets", "separate", "--out", tmp_path / "program")
    robot = kinfer.Robot.load(tmp_path / "arm.urdf", tip="link_J6")
    kinfer.calibrate(robot, poses / "poses.csv").save(tmp_path / "python", offsets="separate")
    for name in ("arm_calibrated.urdf", "joint_origins.yaml", "placement.toml", "model_changes.csv"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name


def test_an_mjcf_is_written_back_as_the_program_does(poses, program, tmp_path):
    program("convert", poses / "robot.toml", "arm.xml", cwd=tmp_path)
    arguments = ["--robot", tmp_path / "arm.xml", "--tip-link", "link_J6", "--data", poses / "poses.csv"]
    program("calibrate", *arguments, "--out", tmp_path / "program")
    robot = kinfer.Robot.load(tmp_path / "arm.xml", tip="link_J6")
    kinfer.calibrate(robot, poses / "poses.csv").save(tmp_path / "python")
    for name in ("arm_calibrated.xml", "placement.toml", "model_changes.csv"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name


def test_arrays_of_positions_and_of_poses(robot, measured):
    joints, poses = measured
    for calibration in (
        kinfer.calibrate(robot, joints, positions=poses[:, :3, 3], sd=1e-5, model="geometry"),
        kinfer.calibrate(robot, joints, positions=poses[:, :3, 3], sd=np.full((40, 3), 1e-5), model="geometry"),
        kinfer.calibrate(robot, joints, poses=poses, sd=1e-5, sd_angle=1e-5, model="geometry"),
    ):
        assert calibration.use, calibration.verdict
        error = calibration.robot.forward(joints)[:, :3, 3] - poses[:, :3, 3]
        assert np.abs(error).max() < 1e-4
        assert calibration.covariance.shape == (len(calibration.parameters),) * 2


def test_rows_that_were_not_measured_are_rows_of_nan(robot, measured):
    joints, poses = measured
    positions = poses[:, :3, 3].copy()
    positions[5] = np.nan
    assert kinfer.calibrate(robot, joints, positions=positions, sd=1e-5, model="geometry").use


def test_set_ups_have_a_base_each(robot, measured):
    joints, poses = measured
    positions = poses[:, :3, 3].copy()
    positions[20:] += [0.5, -0.2, 0.1]
    calibration = kinfer.calibrate(
        robot, joints, positions=positions, sd=1e-5, setup=["a"] * 20 + ["b"] * 20, model="geometry"
    )
    assert calibration.use and any(p["name"] == "base_x@b" for p in calibration.parameters)


@pytest.mark.parametrize(
    "arguments, sentence",
    [
        (dict(), "nothing is measured"),
        (dict(positions=np.zeros((39, 3))), r"positions: expected an array of shape \(40, 3\), found \(39, 3\)"),
        (dict(positions=[[1, np.nan, 0]] * 40), "positions: row 0 .* not finite"),
        (dict(positions=np.ones((40, 3)), sd=np.zeros(40)), "sd: row 0 .* not positive"),
        (dict(positions=np.ones((40, 3)), sd=np.ones(7)), "sd: expected one number"),
        (dict(poses=np.ones((40, 4, 4))), "poses: row 0 .* is not a homogeneous matrix"),
        (dict(poses=np.ones((40, 3, 4))), r"poses: expected an array of shape \(40, 4, 4\)"),
        (dict(positions=np.ones((40, 3)), poses=np.ones((40, 4, 4))), "expected one of them"),
        (dict(positions=np.ones((40, 3)), setup=["a"]), "setup: expected 40 names"),
        (dict(distances=np.ones(40), anchors=np.full(40, 7)), "anchors: row 0 .* is 7"),
        (dict(distances=-np.ones(40)), "distances: row 0"),
        (dict(positions=np.ones((40, 3)), model="magic"), "magic"),
        (dict(positions=np.ones((40, 3)), parameters="some"), "parameters"),
        (dict(positions=np.random.default_rng(1).normal(size=(40, 3)), parameters=["theta99"]), "theta99"),
        (dict(positions=np.ones((40, 3)), holdout=2.0), "holdout: expected a fraction"),
    ],
)
def test_bad_arrays_get_a_sentence(robot, measured, arguments, sentence):
    with pytest.raises(kinfer.InputError, match=sentence):
        kinfer.calibrate(robot, measured[0], **arguments)


def test_progress_is_reported_and_may_raise(robot, measured):
    class Enough(Exception):
        pass

    def stop(stage, fraction):
        assert isinstance(stage, str) and 0.0 <= fraction <= 1.0
        raise Enough

    rng = np.random.default_rng(0)
    joints = rng.uniform(-1.5, 1.5, (1500, 6))
    with pytest.raises(Enough):
        kinfer.calibrate(robot, joints, positions=robot.forward(joints)[:, :3, 3] + rng.normal(0, 1e-4, (1500, 3)),
                         progress=stop)


def test_ctrl_c_stops_a_calibration(robot):
    rng = np.random.default_rng(0)
    joints = rng.uniform(-1.5, 1.5, (3000, 6))
    positions = robot.forward(joints)[:, :3, 3] + rng.normal(0, 1e-4, (3000, 3))
    threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        kinfer.calibrate(robot, joints, positions=positions)


def test_other_threads_run_while_it_calibrates(robot):
    rng = np.random.default_rng(0)
    joints = rng.uniform(-1.5, 1.5, (300, 6))
    positions = robot.forward(joints)[:, :3, 3] + rng.normal(0, 1e-4, (300, 3))
    ticks, done = [], threading.Event()

    def count():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.002)

    counter = threading.Thread(target=count)
    counter.start()
    kinfer.calibrate(robot, joints, positions=positions, threads=1)
    done.set()
    counter.join()
    assert len(ticks) > 10


def test_plan_and_compensate(robot, measured):
    plan = kinfer.plan(robot, 8, candidates=measured[0], sd=2e-5)
    assert plan["joints"].shape == (8, 6) and plan["expected_rms"] > 0
    calibration = kinfer.calibrate(robot, measured[0], positions=measured[1][:, :3, 3], sd=1e-5, model="geometry")
    wanted = np.clip(measured[0][:5], -0.9, 0.6)  # inside the limits
    wanted[:, 4] = 1.0  # away from the wrist's singular posture
    found = kinfer.compensate(calibration.robot, robot, wanted, frames="world")
    assert found["reached"].all()
    target = robot.forward(wanted)[:, :3, 3]
    assert np.abs(calibration.robot.forward(found["joints"])[:, :3, 3] - target).max() < 1e-6
    with pytest.raises(kinfer.InputError, match="either joints or targets"):
        kinfer.compensate(calibration.robot, robot)
