#!/usr/bin/env python3
"""Turns the truth that simul-landmarks writes beside a log into the folder LOG.truth that slamot reads.

    kf_slam_truth.py PATH.txt LANDMARKS.txt LOG.truth [--step 0.1]

PATH.txt (..._ground_truth_robot_path.txt) has a row `x y z yaw pitch roll` for each step and LANDMARKS.txt
(..._ground_truth.txt) a row `x y z _ _ _ id` for each landmark. Such logs have no usable stamps, so slamot counts
their steps from its epoch, `[log] step` seconds each: row i belongs to step i.
"""
import argparse
import json
import pathlib

EPOCH = 1577836800  # 2020-01-01 00:00 UTC, RawlogReader.h


def rows(path):
    for line in pathlib.Path(path).read_text().splitlines():
        if line.strip() and not line.startswith("%"):
            yield line.split()


def write_truth(path_file, landmarks_file, folder, step=0.1):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "robot.csv", "w") as out:
        out.write("t,x,y,theta\n")
        for i, row in enumerate(rows(path_file)):
            ticks = i * round(step * 10_000_000)
            t = f"{EPOCH + ticks // 10_000_000}.{ticks % 10_000_000:07d}"
            out.write(f"{t},{float(row[0])!r},{float(row[1])!r},{float(row[3])!r}\n")
    with open(folder / "landmarks.csv", "w") as out:
        out.write("id,x,y\n")
        for row in rows(landmarks_file):
            out.write(f"{int(row[6])},{float(row[0])!r},{float(row[1])!r}\n")
    (folder / "truth.json").write_text(
        json.dumps({"frame": "world", "source": "simul-landmarks", "position_std": 0}, indent=2) + "\n")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path_file")
    parser.add_argument("landmarks_file")
    parser.add_argument("folder")
    parser.add_argument("--step", type=float, default=0.1, help="[s], `[log] step` of the run")
    a = parser.parse_args()
    write_truth(a.path_file, a.landmarks_file, a.folder, a.step)
