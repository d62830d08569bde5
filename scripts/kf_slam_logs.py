#!/usr/bin/env python3
"""Makes the logs of config/studies/kf_slam.ini: MRPT's kf-slam_demo.rawlog, linked, and logs of its simul-landmarks.

    scripts/kf_slam_logs.py [--logs 30]

They land in build/kf_slam with their truth. Needs the package mrpt-apps (simul-landmarks) and the data of mrpt-common.
"""
import argparse
import math
import os
import pathlib
import subprocess

from kf_slam_truth import write_truth

ROOT = pathlib.Path(__file__).resolve().parents[1]
MRPT_DATASETS = pathlib.Path("/usr/share/mrpt/datasets")
DENSITY = 0.3  # landmarks per m^2
MAX_RANGE = 8  # [m]

# A square path in the middle of a square world, one and a quarter times round: the map grows on the first round and
# the last quarter goes over known ground. The robot stands for 4 of simul-landmarks' steps, then moves 0.2 m a step
# and turns in 4 steps at each corner. Odometry and sensor noise as in MRPT's own demo.
SIMULATION = """[Params]
random_seed = {seed}
nSteps = {steps}
circularPath = 0
squarePathLength = {side_steps}
odometryNoiseXY_std = 0.04
minSensorDistance = 0
maxSensorDistance = {max_range}
fieldOfView_deg = 180
stdRange = 0.01
stdYaw_deg = 0.1
stdPitch_deg = 0
outFile = {name}.rawlog
outDir = {folder}
show_in_3d = false
[RANDOMSET_1]
nLandmarks = {landmarks}
min_x = {low}
max_x = {high}
min_y = {low}
max_y = {high}
min_z = 0
max_z = 0
"""


def simulate(folder, landmarks, seed):
    log = folder / f"landmarks_{landmarks}_seed_{seed}.rawlog"
    if log.exists() and log.with_suffix(".truth").exists():
        return log
    world = math.sqrt(landmarks / DENSITY)
    path, margin = 0.6 * world, 0.2 * world
    side_steps = round(path / 0.2) + 4
    name = log.stem
    ini = folder / f"{name}.ini"
    ini.write_text(SIMULATION.format(seed=seed, steps=5 * side_steps, side_steps=side_steps, name=name, folder=folder,
                                     max_range=MAX_RANGE, landmarks=landmarks, low=-margin, high=path + margin))
    subprocess.run(["simul-landmarks", ini], check=True, stdout=subprocess.DEVNULL)
    write_truth(f"{log}_ground_truth_robot_path.txt", f"{log}_ground_truth.txt", log.with_suffix(".truth"))
    return log


def demo(folder):
    """The demo's log must stand beside its truth: a link to it does."""
    log = folder / "kf-slam_demo.rawlog"
    if not log.exists():
        os.symlink(MRPT_DATASETS / "kf-slam_demo.rawlog", log)
    write_truth(MRPT_DATASETS / "kf-slam_demo_ground_truth_robot_path.txt", MRPT_DATASETS / "kf-slam_demo_ground_truth.txt",
                log.with_suffix(".truth"))
    return log


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="*", default=[50, 100, 200, 400])
    parser.add_argument("--logs", type=int, default=30, help="logs of each size, with seeds 1, 2, ...")
    parser.add_argument("--large-logs", type=int, default=5, help="logs of each size from 200 landmarks on")
    a = parser.parse_args()
    folder = ROOT / "build/kf_slam"
    folder.mkdir(parents=True, exist_ok=True)
    demo(folder)
    for landmarks in a.sizes:
        for seed in range(1, (a.logs if landmarks < 200 else a.large_logs) + 1):
            simulate(folder, landmarks, seed)


if __name__ == "__main__":
    main()
