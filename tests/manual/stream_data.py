#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a reader of the manual would log: joints.csv of the controller, tracker.csv on another clock.

Both hold the poses of data/poses.csv as rests of 2 s with 1 s of motion between; the tracker's clock is 3.2 s ahead.
"""
import csv

with open("data/poses.csv", newline="") as file:
    header, *rows = list(csv.reader(file))
poses = [[float(cell) for cell in row[:9]] for row in rows]


def stream(path: str, header: list[str], columns: slice, offset: float) -> None:
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["t", *header[columns]])
        for i, pose in enumerate(poses):
            after = poses[min(i + 1, len(poses) - 1)]
            for k in range(30):
                share = max(0, k - 19) / 11  # 20 rows of rest, 10 of motion
                values = [(1 - share) * a + share * b for a, b in zip(pose[columns], after[columns])]
                writer.writerow([f"{3 * i + k / 10 + offset:.1f}", *(f"{value:.5f}" for value in values)])


stream("joints.csv", header, slice(0, 6), 0.0)
stream("tracker.csv", header, slice(6, 9), 3.2)
