# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import kinfer


@pytest.fixture(scope="session")
def machine(drive, tmp_path_factory):
    folder = tmp_path_factory.mktemp("machine")
    kinfer.identify(drive / "imu.csv").save(folder)
    return folder


@pytest.mark.parametrize("smooth", [False, True])
def test_the_files_are_the_programs_byte_for_byte(drive, machine, program, tmp_path, smooth):
    program("track", machine, drive / "imu.csv", "--out", tmp_path / "program", *(["--smooth"] if smooth else []))
    kinfer.track(machine, drive / "imu.csv", smooth=smooth).save(tmp_path / "python")
    for file in (tmp_path / "program").iterdir():
        if file.name != "run.json":
            assert (tmp_path / "python" / file.name).read_bytes() == file.read_bytes(), file.name


def test_arrays_have_the_shapes_that_are_stated(drive, machine):
    run = kinfer.track(machine, drive / "imu.csv")
    n, dof = run.q.shape
    assert run.use and dof == len(run.joint_names) == run.qd.shape[1]
    assert run.time.shape == (n,) and run.tool.shape == (n, 4, 4) and run.sd_tool.shape == (n, 6)
    known = np.isfinite(run.q).all(axis=1)
    assert known.mean() > 0.99
    turns = run.tool[known][:, :3, :3]
    assert np.abs(turns @ turns.transpose(0, 2, 1) - np.eye(3)).max() < 1e-9
    assert np.allclose(np.linalg.norm(run.base, axis=1), 1)
    assert (run.sd_q[known] > 0).all()


def test_a_recording_gives_the_positions_of_its_file(drive, machine):
    from_file = kinfer.track(machine, drive / "imu.csv")
    from_recording = kinfer.track(machine, kinfer.read_log(drive / "imu.csv"))
    # A recording holds its samples in single precision.
    assert np.nanmax(np.abs(from_file.q - from_recording.q)) < 1e-5


def test_row_by_row_gives_the_same_positions(drive, machine):
    sensors = kinfer.read_log(drive / "imu.csv").sensors
    tracker = kinfer.Tracker(machine)
    run = kinfer.track(machine, kinfer.read_log(drive / "imu.csv"))
    acc = np.stack([sensors[name]["acc"] for name in tracker.sensors], axis=1)
    gyr = np.stack([sensors[name]["gyr"] for name in tracker.sensors], axis=1)
    for k in range(1000):
        tracker.add(run.time[k], acc[k], gyr[k])
    assert tracker.started and tracker.alarms == []
    assert np.array_equal(tracker.q, run.q[999]) and np.array_equal(tracker.tool, run.tool[999])


def test_where_it_starts_can_be_stated(drive, machine):
    free = kinfer.track(machine, drive / "imu.csv")
    stated = kinfer.track(machine, drive / "imu.csv", start=[0.1] + [np.nan] * (free.q.shape[1] - 1))
    first = np.isfinite(stated.q[:, 0]).argmax()
    assert abs(stated.q[first, 0] - 0.1) < 0.01


def test_bad_input_gets_a_sentence(drive, machine, tmp_path):
    log = drive / "imu.csv"
    with pytest.raises(kinfer.InputError, match="expected a folder that kinfer identify wrote"):
        kinfer.track(tmp_path / "none", log)
    with pytest.raises(kinfer.InputError, match="base: .*expected auto, still or moving"):
        kinfer.track(machine, log, base="flying")
    with pytest.raises(kinfer.InputError, match="start: "):
        kinfer.track(machine, log, start=[0.0])
    with pytest.raises(kinfer.InputError, match="the chain has a sensor"):
        t = np.arange(50) / 100
        kinfer.track(machine, {"boom": dict(t=t, acc=np.tile([0, 0, 9.81], (50, 1)), gyr=np.zeros((50, 3)))})
    tracker = kinfer.Tracker(machine)
    still = np.zeros((len(tracker.sensors), 3))
    with pytest.raises(kinfer.InputError, match="acc: expected an array of shape"):
        tracker.add(0.0, np.zeros((2, 3)), still)
    tracker.add(1.0, still, still)
    with pytest.raises(kinfer.InputError, match="is before"):
        tracker.add(0.5, still, still)


def test_ctrl_c_ends_it(drive, machine):
    class Stop(Exception):
        pass

    def stop(stage, fraction):
        raise Stop

    with pytest.raises(Stop):
        kinfer.track(machine, drive / "imu.csv", smooth=True, progress=stop)
