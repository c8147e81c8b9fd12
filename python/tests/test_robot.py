# SPDX-License-Identifier: Apache-2.0
import subprocess
import sys
import time

import numpy as np
import pytest

import kinfer


def test_forward_agrees_with_the_program(robot, poses, program, tmp_path):
    joints = kinfer.read_poses(poses / "poses.csv", robot).joints
    program("predict", "--chain", poses / "robot.toml", "--joints", poses / "poses.csv", "-o", tmp_path / "p.csv")
    expected = np.genfromtxt(tmp_path / "p.csv", delimiter=",", skip_header=1)[:, :3]
    found = robot.forward(joints)
    assert found.shape == (len(joints), 4, 4)
    assert np.abs(found[:, :3, 3] - expected).max() < 1e-12
    assert np.allclose(found[:, 3], [0, 0, 0, 1])


def test_one_row_gives_one_pose(robot):
    q = np.array([0.1, -0.2, 0.3, 0.4, -0.5, 0.6])
    assert robot.forward(q).shape == (4, 4)
    assert (robot.forward(q) == robot.forward(q[None])[0]).all()


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("dtype", [np.float64, np.float32, int])
def test_order_and_type_of_the_array_do_not_matter(robot, order, dtype):
    q = np.array(np.arange(30).reshape(5, 6) % 3, dtype=dtype, order=order)
    expected = robot.forward(np.ascontiguousarray(q, dtype=float))
    assert (robot.forward(q) == expected).all()
    assert (robot.forward(q.tolist()) == expected).all()
    q.flags.writeable = False
    assert (robot.forward(q) == expected).all()
    assert (robot.forward(np.repeat(q, 2, axis=0)[::2]) == expected).all()


class Frame:
    """Looks like a pandas.DataFrame."""

    def __init__(self, columns):
        self.table = columns
        self.columns = list(columns)

    def __getitem__(self, names):
        return Frame({name: self.table[name] for name in names})

    def __array__(self, dtype=None):
        return np.column_stack(list(self.table.values())).astype(dtype)


def test_columns_of_a_frame_are_found_by_name(robot):
    q = np.random.default_rng(1).uniform(-1, 1, (7, 6))
    frame = Frame({"id": np.arange(7), **{f"q{k + 1}": q[:, k] for k in reversed(range(6))}})
    assert (robot.forward(frame) == robot.forward(q)).all()


@pytest.mark.parametrize(
    "joints, sentence",
    [
        (np.zeros((4, 5)), r"joints: expected an array of shape \(n, 6\), found \(4, 5\)"),
        (np.zeros((2, 6, 1)), r"joints: expected an array of shape \(n, 6\)"),
        (np.zeros((0, 6)), "joints: the array is empty"),
        (np.full((3, 6), np.nan), r"joints: row 0 \(from 0\) has a number that is not finite"),
        (np.full((3, 6), 90.0), "joints: the angles seem to be in degrees"),
        ("abcdef", "joints: expected an array of numbers, found str"),
        ([["a"] * 6], "joints: expected an array of numbers, found list"),
        (np.zeros((3, 6), dtype="datetime64[s]"), "joints: expected an array of numbers"),
    ],
)
def test_bad_joint_positions_get_a_sentence(robot, joints, sentence):
    with pytest.raises(kinfer.InputError, match=sentence):
        robot.forward(joints)


def test_input_errors_are_value_errors_with_the_programs_sentence(tmp_path):
    with pytest.raises(ValueError, match="no such file"):
        kinfer.Robot.load(tmp_path / "none.toml")
    (tmp_path / "two.urdf").write_text("<robot name='a'><link name='b'/><link name='c'/></robot>")
    with pytest.raises(kinfer.InputError, match="two.urdf:1: the robot has no joints"):
        kinfer.Robot.load(tmp_path / "two.urdf")


def test_a_urdf_of_300_links_is_read(tmp_path):
    links = "".join(f"<link name='l{i}'/>" for i in range(301))
    joints = "".join(
        f"<joint name='j{i}' type='continuous'><parent link='l{i}'/><child link='l{i + 1}'/></joint>" for i in range(300)
    )
    (tmp_path / "long.urdf").write_text(f"<robot name='long'>{links}{joints}</robot>")
    assert kinfer.Robot.load(tmp_path / "long.urdf").dof == 300
    assert kinfer.Robot.load(tmp_path / "long.urdf", base="l10", tip="l20").dof == 10


def test_a_hundred_thousand_poses_take_no_time(robot):
    q = np.random.default_rng(1).uniform(-2, 2, (100_000, 6))
    robot.forward(q[:10])
    seconds = min(timed(lambda: robot.forward(q)) for _ in range(5))
    assert seconds < 0.3, seconds  # 30 ms on an idle core; generous, as machines are shared


def timed(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def test_models_are_saved_and_loaded(robot, tmp_path):
    robot.save(tmp_path / "copy.toml")
    q = np.random.default_rng(2).uniform(-1, 1, (5, 6))
    copy = kinfer.Robot.load(tmp_path / "copy.toml")
    assert np.abs(copy.forward(q) - robot.forward(q)).max() < 1e-12
    assert copy.joint_names == robot.joint_names and copy.dof == 6
    assert robot.limits.shape == (6, 2) and robot.base.shape == (4, 4) and robot.tool.shape == (4, 4)


def test_the_package_is_imported_fast():
    done = subprocess.run(
        [sys.executable, "-c", "import time, numpy; t = time.perf_counter(); import kinfer; print(time.perf_counter() - t)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert float(done.stdout) < 1.0  # 0.15 s on an idle machine
