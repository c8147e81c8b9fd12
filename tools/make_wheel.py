# SPDX-License-Identifier: Apache-2.0
"""Packs a built Python package as a wheel: make_wheel.py PACKAGE_FOLDER VERSION OUT_FOLDER.

The same bytes for the same files (no dates). Its tag is that of the running interpreter, so that pip refuses it on
another one. The libraries that the module is linked against are those of the system.
"""

import base64
import hashlib
import sys
import sysconfig
import zipfile
from pathlib import Path


def record_line(name: str, content: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def main() -> None:
    package, version, out = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag = f"{python}-{python}-{platform}"
    info = f"kinfer-{version}.dist-info"
    this, following = f"{sys.version_info.major}.{sys.version_info.minor}", f"{sys.version_info.major}.{sys.version_info.minor + 1}"
    files = {f"kinfer/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files[f"{info}/METADATA"] = (
        f"Metadata-Version: 2.1\nName: kinfer\nVersion: {version}\n"
        "Summary: From raw measurements to a proven kinematic model\nLicense: Apache-2.0\n"
        f"Requires-Python: >={this},<{following}\nRequires-Dist: numpy>=1.24\n"
    ).encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: kinfer\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = "".join(record_line(name, content) for name, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    out.mkdir(parents=True, exist_ok=True)
    wheel = out / f"kinfer-{version}-{tag}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    print(wheel)


if __name__ == "__main__":
    main()
