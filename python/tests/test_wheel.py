# SPDX-License-Identifier: Apache-2.0
import base64
import hashlib
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import kinfer

SOURCE = Path(os.environ["KINFER_SOURCE_DIR"])


def make(folder):
    package = Path(kinfer.__file__).parent
    done = subprocess.run(
        [sys.executable, SOURCE / "tools/make_wheel.py", package, kinfer.__version__, folder],
        capture_output=True,
        text=True,
        check=True,
    )
    return Path(done.stdout.strip())


def test_a_wheel_is_complete_reproducible_and_for_one_python(tmp_path):
    wheel = make(tmp_path / "one")
    assert wheel.read_bytes() == make(tmp_path / "two").read_bytes()
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    assert f"-{tag}-{tag}-" in wheel.name  # pip refuses it on another Python
    archive = zipfile.ZipFile(wheel)
    names = archive.namelist()
    record = next(name for name in names if name.endswith("RECORD"))
    listed = dict(line.split(",")[:2] for line in archive.read(record).decode().splitlines())
    assert set(listed) == set(names)
    for name in names:
        if name != record:
            digest = base64.urlsafe_b64encode(hashlib.sha256(archive.read(name)).digest()).rstrip(b"=").decode()
            assert listed[name] == f"sha256={digest}", name
    archive.extractall(tmp_path / "site")
    done = subprocess.run(
        [sys.executable, "-c", "import kinfer; print(kinfer.__file__)"],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(tmp_path / "site")},
        cwd=tmp_path,
    )
    assert done.stdout.startswith(str(tmp_path / "site"))
