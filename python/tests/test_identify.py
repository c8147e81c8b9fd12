# SPDX-License-Identifier: Apache-2.0
import os
import signal
import threading
import time

import numpy as np
import pytest

import kinfer


def test_the_evidence_is_the_programs_byte_for_byte(drive, program, tmp_path):
    program("identify", drive / "imu.csv", "--out", tmp_path / "program")
    machine = kinfer.identify(drive / "imu.csv")
    machine.save(tmp_path / "python")
    for file in (tmp_path / "program").iterdir():
        if file.name != "run.json":
            assert (tmp_path / "python" / file.name).read_bytes() == file.read_bytes(), file.name
    assert machine.evidence["joints"] == machine.joints


def test_an_update_is_the_programs_byte_for_byte(drive, program, tmp_path):
    kinfer.identify(drive / "imu.csv").save(tmp_path / "old")
    program("simulate", "robot6", "--grade", "noise", "--drive", 2, "--out", tmp_path / "later")
    later = tmp_path / "later" / "imu.csv"
    copy = tmp_path / "copy.csv"
    copy.write_bytes((drive / "imu.csv").read_bytes() + b"# another day\n")
    program("identify", "--update", tmp_path / "old", later, "--out", tmp_path / "program")
    machine = kinfer.identify(later, update=tmp_path / "old")
    machine.save(tmp_path / "python")
    for name in ("evidence.json", "chain.toml", "track.toml"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "program" / name).read_bytes(), name
    assert machine.evidence["update"]["changes"] == []
    for used in (drive / "imu.csv", copy, later):
        with pytest.raises(kinfer.InputError, match="would count twice"):
            kinfer.identify(used, update=machine)


def test_arrays_give_the_chain_of_the_file(drive):
    recording = kinfer.read_log([drive / "imu.csv"])
    sensors = recording.sensors
    assert all(s["acc"].shape == (len(s["t"]), 3) for s in sensors.values())
    from_file = kinfer.identify(recording)
    from_arrays = kinfer.identify({name: dict(s) for name, s in sensors.items()})
    assert from_arrays.joints == from_file.joints
    assert from_arrays.robot.dof == from_file.robot.dof


def test_orientations_are_unit_quaternions(drive, program, tmp_path):
    program("orient", drive / "imu.csv", "-o", tmp_path / "q.csv", "--filter", "kinfer-offline")
    expected = np.genfromtxt(tmp_path / "q.csv", delimiter=",", skip_header=1)
    found = kinfer.orient(drive / "imu.csv")
    stacked = np.column_stack(list(found.values()))
    assert np.abs(stacked - expected[:, 1:]).max() < 5.1e-8  # the file has seven decimals
    assert np.allclose(np.linalg.norm(stacked[:, :4], axis=1), 1)


N = 50
GOOD = dict(t=np.arange(N) / 100, acc=np.tile([0, 0, 9.81], (N, 1)), gyr=np.zeros((N, 3)))


@pytest.mark.parametrize(
    "columns, sentence",
    [
        ({**GOOD, "t": np.zeros(N)}, r"boom: t\[1\] = 0 is not after"),
        ({**GOOD, "acc": np.zeros((N, 2))}, r"boom: acc: expected an array of shape \(n, 3\), found \(50, 2\)"),
        ({**GOOD, "gyr": np.zeros((7, 3))}, "boom: gyr has 7 rows and t has 50"),
        ({**GOOD, "acc": GOOD["acc"] / 9.81}, "gravity"),
        ({"t": GOOD["t"]}, "boom: expected acc"),
        ({"acc": GOOD["acc"], "gyr": GOOD["gyr"]}, "boom: expected t"),
    ],
)
def test_bad_columns_get_a_sentence(columns, sentence):
    with pytest.raises(kinfer.InputError, match=sentence):
        kinfer.identify({"boom": columns})


def test_ctrl_c_stops_an_identification(drive):
    recording = kinfer.read_log(drive / "imu.csv")
    begin = time.perf_counter()
    kinfer.identify(recording)
    whole = time.perf_counter() - begin
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.1 * whole, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        kinfer.identify(recording)
    timer.join()
    assert time.perf_counter() - sent[0] < 0.7 * whole  # it does not go on to the end


def test_something_else_gets_a_sentence(tmp_path):
    with pytest.raises(kinfer.InputError, match="expected a recording"):
        kinfer.identify(3)
    with pytest.raises(kinfer.InputError, match="no such file"):
        kinfer.read_log(tmp_path / "none.csv")
