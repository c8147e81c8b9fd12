#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a reader of the manual would measure by contact, from the robot of `kinfer demo` with its known errors.

Writes sockets.csv (a ball in two sockets, 30 arm configurations each), wire.csv (a draw wire from three anchors),
wired.toml (the data sheet with rough anchors). Run in the folder that `kinfer demo` made, with kinfer on PATH.
"""
import csv
import math
import random
import re
import subprocess
from pathlib import Path

rng = random.Random(5)
# The robot as it is, without the place of the tracker: its base is the world.
truth = re.sub(r"(?m)^(base|world_T_base).*\n", "", Path("data/truth.toml").read_text())
anchors = [[1803, -894, 105], [1797, 905, 96], [402, 1493, 904]]  # [mm], where they are
rough = [[1800, -900, 100], [1800, 900, 100], [400, 1500, 900]]   # where the data sheet says
scale = 1e-3 if not re.search(r'length *= *"mm"', truth) else 1.0
Path("truth_in_cell.toml").write_text(truth.replace("[[joint]]", f"anchors = {[[v * scale for v in a] for a in anchors]}\n\n[[joint]]", 1))


def kinfer(*arguments: str) -> None:
    subprocess.run(["kinfer", *arguments], check=False, stderr=subprocess.DEVNULL)


def rows(path: str) -> list[dict[str, str]]:
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def write(path: str, header: list[str], lines: list[list[object]]) -> None:
    with open(path, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *lines])


joints = [f"q{i}[deg]" for i in range(1, 7)]

# Sockets: the same point from many sides, the tool pointing downwards or to a side.
targets = []
for name, point in (("near", (0.9, -0.3, 0.5)), ("far", (1.1, 0.5, 0.9))):
    for _ in range(45):
        tilt, turn, spin = math.radians(rng.uniform(100, 180)), rng.uniform(0, 2 * math.pi), rng.uniform(-1.5, 1.5)
        c, s = math.cos(tilt / 2), math.sin(tilt / 2)  # Rz(turn) Ry(tilt) Rz(spin - turn)
        half_sum, half_difference = spin / 2, turn - spin / 2
        targets.append((name, [*(x + rng.gauss(0, 2e-5) for x in point), c * math.cos(half_sum), -s * math.sin(half_difference), s * math.cos(half_difference), c * math.sin(half_sum)]))
write("targets.csv", ["x[m]", "y[m]", "z[m]", "qw", "qx", "qy", "qz"], [target for _, target in targets])
kinfer("reach", "--chain", "truth_in_cell.toml", "--targets", "targets.csv", "-o", "reached.csv", "--quiet")
contacts = [[*(round(math.degrees(float(row[f"q{i}"])), 4) for i in range(1, 7)), targets[int(row["target"]) - 1][0]]
            for row in rows("reached.csv") if row["status"] == "reached"]
write("sockets.csv", [*joints, "socket"], contacts)

# Draw wire: the length of each pose from one anchor.
limits = [(-60, 60), (-100, 0), (-30, 60), (-120, 120), (-80, 80), (-120, 120)]
poses = [[*(round(rng.uniform(*limit), 3) for limit in limits), 1 + i % 3] for i in range(60)]
write("wire_joints.csv", [*joints, "anchor"], poses)
kinfer("predict", "--chain", "truth_in_cell.toml", "--joints", "wire_joints.csv", "-o", "wire_true.csv", "--quiet")
wire = [[*pose, round(1e3 * float(row["distance"]) + rng.gauss(0, 0.05), 3)] for pose, row in zip(poses, rows("wire_true.csv"))]
write("wire.csv", [*joints, "anchor", "distance[mm]"], wire)
sheet = Path("robot/robot.toml").read_text().replace("[[joint]]", f"anchors = {rough}\n\n[[joint]]", 1)
Path("wired.toml").write_text(sheet.replace("[instrument]", "[tolerance]\nanchor = 10\n\n[instrument]\nsigma_distance = 0.05"))
