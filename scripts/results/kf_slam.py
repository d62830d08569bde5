#!/usr/bin/env python3
"""Beside MRPT's kf-slam: makes the logs, measures both filters, fills doc/results/kf_slam.md.

    cmake -S . -B build/release -G Ninja -DCMAKE_BUILD_TYPE=Release -DSLAMOT_BUILD_BENCH=ON
    ninja -C build/release
    scripts/results/kf_slam.py

Needs the package mrpt-apps (simul-landmarks) and the data of mrpt-common. Logs: MRPT's kf-slam_demo.rawlog, and of
each size several of simul-landmarks, with seeds 1, 2, ... Time is measured on a few logs of each size; error on more
of the small ones. build/kf_slam/ keeps the logs and the figures as JSON; --tables fills the page from those again.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess

from common import ROOT, SLAMOT, fill, stamp, table
from kf_slam_truth import write_truth

MRPT_DATASETS = pathlib.Path("/usr/share/mrpt/datasets")
DENSITY = 0.3  # landmarks per m^2
MAX_RANGE = 8  # [m]
FILTERS = ("kf-slam", "classic", "invariant")

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


def measure(logs, repetitions=1, range_std=0.03, extra=()):
    """Trials of all logs: {filter: {figure: value}} each."""
    program = SLAMOT.parent / "kf_slam_comparison"
    command = [program, *logs, "--config", ROOT / "config/runs/kf_slam_demo.ini", "--repetitions", str(repetitions),
               "--range-std", str(range_std), *extra]
    result = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    return [trial for log in result["logs"] for trial in log["trials"]]


def spread(values, digits):
    """Median, in brackets least and most."""
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f}-{max(values):.{digits}f})"


def of(trials, filter_, key):
    return [t[filter_][key] for t in trials]


def ratios(trials, filter_, key):
    return [a / b for a, b in zip(of(trials, "kf-slam", key), of(trials, filter_, key))]


def time_table(groups, key):
    rows = []
    for name, trials in groups.items():
        ends = sorted(set(of(trials, "kf-slam", "landmarks")))
        for f in FILTERS:
            assert of(trials, f, "landmarks") == of(trials, "kf-slam", "landmarks"), "the maps differ"
        rows.append([name, len(trials), trials[0]["kf-slam"]["frames"],
                     f"{statistics.median(of(trials, 'kf-slam', 'seen_median')):.0f}",
                     ends[0] if len(ends) == 1 else f"{ends[0]}-{ends[-1]}"]
                    + [spread(of(trials, f, key), 3) for f in FILTERS]
                    + [spread(ratios(trials, f, key), 1) for f in FILTERS[1:]])
    return table(["log", "trials", "frames", "seen", "map at end", "kf-slam [ms]", "classic [ms]", "invariant [ms]",
                  "kf-slam : classic", "kf-slam : invariant"], rows)


def error_table(groups):
    rows = []
    for name, trials in groups.items():
        errors = {f: [1e3 * t[f]["rmse"]["position_m"] for t in trials] for f in FILTERS}
        row = [name, len(trials)] + [f"{statistics.mean(errors[f]):.3f}" for f in FILTERS]
        for f in FILTERS[1:]:
            paired = [a / b for a, b in zip(errors[f], errors["kf-slam"])]
            half = 1.96 * statistics.stdev(paired) / math.sqrt(len(paired)) if len(paired) > 1 else None
            row.append(f"{statistics.mean(paired):.4f}" + (f" ± {half:.4f}" if half is not None else ""))
        row += [f"{statistics.mean(1e3 * t[f]['rmse']['heading_rad'] for t in trials):.3f}" for f in FILTERS]
        rows.append(row)
    return table(["log", "logs", "kf-slam [mm]", "classic [mm]", "invariant [mm]", "classic : kf-slam",
                  "invariant : kf-slam", "kf-slam [mrad]", "classic [mrad]", "invariant [mrad]"], rows)


def fill_page(figures):
    timed = figures["timed"]
    fill("kf_slam.md", "times", figures["stamp"] + "\n\n" + time_table(timed, "mean_ms"))
    fill("kf_slam.md", "last-quarter", time_table(timed, "last_quarter_mean_ms"))
    # Passes over one log give one error: all filters are deterministic.
    errors = {name: trials[:1] if name == "kf-slam_demo" else trials for name, trials in timed.items()}
    fill("kf_slam.md", "errors", error_table({**errors, **figures["errors"]}))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="*", default=[50, 100, 200, 400])
    parser.add_argument("--logs", type=int, default=5, help="timed logs of each size, and passes over the demo")
    parser.add_argument("--error-sizes", type=int, nargs="*", default=[50, 100])
    parser.add_argument("--error-logs", type=int, default=30, help="logs of each size for the errors alone")
    parser.add_argument("--tables", action="store_true", help="only fill the page from figures measured before")
    a = parser.parse_args()
    folder = ROOT / "build/kf_slam"
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / "figures.json"
    if not a.tables:
        timed = {"kf-slam_demo": measure([demo(folder)], repetitions=a.logs)}
        for n in a.sizes:
            extra = ["--figure", ROOT / "doc/results/kf_slam_time"] if n == max(a.sizes) else []
            timed[f"{n} landmarks"] = measure([simulate(folder, n, seed + 1) for seed in range(a.logs)], extra=extra)
        errors = {}
        for n in a.error_sizes:
            logs = [simulate(folder, n, seed + 1) for seed in range(a.error_logs)]
            for range_std in (0.03, 0.01):
                errors[f"{n} landmarks, range noise told {range_std} m"] = measure(logs, range_std=range_std)
        kept.write_text(json.dumps({"stamp": stamp(), "timed": timed, "errors": errors}))
    fill_page(json.loads(kept.read_text()))


if __name__ == "__main__":
    main()
