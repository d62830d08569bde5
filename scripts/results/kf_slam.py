#!/usr/bin/env python3
"""Beside MRPT's kf-slam: makes the logs, measures both filters, writes the tables of doc/results/kf_slam.md.

    cmake -S . -B build/release -DCMAKE_BUILD_TYPE=Release -DSLAMOT_BUILD_BENCH=ON && ninja -C build/release
    python3 scripts/results/kf_slam.py --build build/release --out build/kf_slam

Needs the package mrpt-apps (simul-landmarks) and the data of mrpt-common. Logs: MRPT's kf-slam_demo.rawlog, and of
each size as many logs of simul-landmarks as asked for, with seeds 1, 2, ...
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import statistics
import subprocess

from kf_slam_truth import write_truth

DATASETS = pathlib.Path("/usr/share/mrpt/datasets")
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
    world = math.sqrt(landmarks / DENSITY)
    path, margin = 0.6 * world, 0.2 * world
    side_steps = round(path / 0.2) + 4
    name = f"landmarks_{landmarks}_seed_{seed}"
    ini = folder / f"{name}.ini"
    ini.write_text(SIMULATION.format(seed=seed, steps=5 * side_steps, side_steps=side_steps, name=name, folder=folder,
                                     max_range=MAX_RANGE, landmarks=landmarks, low=-margin, high=path + margin))
    subprocess.run(["simul-landmarks", ini], check=True, stdout=subprocess.DEVNULL)
    log = folder / f"{name}.rawlog"
    write_truth(f"{log}_ground_truth_robot_path.txt", f"{log}_ground_truth.txt", log.with_suffix(".truth"))
    return log


def demo(folder):
    """The demo's log must stand beside its truth: a link to it does."""
    log = folder / "kf-slam_demo.rawlog"
    if not log.exists():
        os.symlink(DATASETS / "kf-slam_demo.rawlog", log)
    write_truth(DATASETS / "kf-slam_demo_ground_truth_robot_path.txt", DATASETS / "kf-slam_demo_ground_truth.txt",
                log.with_suffix(".truth"))
    return log


def measure(program, config, logs, repetitions, range_std, extra):
    command = [program, *logs, "--config", config, "--repetitions", str(repetitions), "--range-std", str(range_std)]
    return json.loads(subprocess.run(command + extra, check=True, stdout=subprocess.PIPE).stdout)


def spread(values, digits):
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f}-{max(values):.{digits}f})"


def table(groups):
    """One line per group of trials: medians over trials, in brackets least and most."""
    lines = ["| log | trials | frames | seen | landmarks at end | kf-slam [ms] | classic [ms] | invariant [ms] "
             "| kf-slam : classic | kf-slam : invariant |", "|---|" + "---:|" * 9]
    for name, trials in groups:
        of = lambda filter_, key: [t[filter_][key] for t in trials]
        times = {f: of(f, "mean_ms") for f in FILTERS}
        ratio = lambda f: [a / b for a, b in zip(times["kf-slam"], times[f])]
        ends = sorted(set(of("kf-slam", "landmarks")))
        for f in FILTERS:
            assert of(f, "landmarks") == of("kf-slam", "landmarks"), "the maps differ"
        lines.append(f"| {name} | {len(trials)} | {trials[0]['kf-slam']['frames']} "
                     f"| {statistics.median(of('kf-slam', 'seen_median')):.0f} "
                     f"| {ends[0] if len(ends) == 1 else f'{ends[0]}-{ends[-1]}'} "
                     + "".join(f"| {spread(times[f], 3)} " for f in FILTERS)
                     + "".join(f"| {spread(ratio(f), 1)} " for f in FILTERS[1:]) + "|")
    return "\n".join(lines)


def full_map_table(groups):
    lines = ["| log | kf-slam [ms] | classic [ms] | invariant [ms] | kf-slam : classic | kf-slam : invariant |",
             "|---|" + "---:|" * 5]
    for name, trials in groups:
        times = {f: [t[f]["last_quarter_mean_ms"] for t in trials] for f in FILTERS}
        lines.append(f"| {name} " + "".join(f"| {spread(times[f], 3)} " for f in FILTERS)
                     + "".join(f"| {spread([a / b for a, b in zip(times['kf-slam'], times[f])], 1)} "
                               for f in FILTERS[1:]) + "|")
    return "\n".join(lines)


def error_table(groups):
    lines = ["| log | logs | kf-slam [mm] | classic [mm] | invariant [mm] | kf-slam [mrad] | classic [mrad] "
             "| invariant [mrad] | logs where invariant is worse by over 1 % |", "|---|" + "---:|" * 8]
    for name, trials in groups:
        # Passes over one log give one error: filters are deterministic.
        unique = {json.dumps(t["kf-slam"]["rmse"]): t for t in trials}.values()
        of = lambda f, key: [1e3 * t[f]["rmse"][key] for t in unique]
        worse = sum(b > 1.01 * a for a, b in zip(of("kf-slam", "position_m"), of("invariant", "position_m")))
        lines.append(f"| {name} | {len(unique)} "
                     + "".join(f"| {spread(of(f, 'position_m'), 2)} " for f in FILTERS)
                     + "".join(f"| {spread(of(f, 'heading_rad'), 3)} " for f in FILTERS) + f"| {worse} |")
    return "\n".join(lines)


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return f"{line.split(':')[1].strip()}, {os.cpu_count()} cores"
    return f"{os.cpu_count()} cores"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--sizes", type=int, nargs="*", default=[50, 100, 200, 400])
    parser.add_argument("--logs", type=int, default=5, help="logs of each size")
    parser.add_argument("--repetitions", type=int, default=5, help="passes over the demo; other logs are passed once")
    parser.add_argument("--range-std", type=float, default=0.03, help="[m], given to both; logs have 0.01")
    parser.add_argument("--certain-start", action="store_true",
                        help="slamot too takes the movements before the first detection as certain")
    a = parser.parse_args()
    extra = ["--certain-start"] if a.certain_start else []
    a.out.mkdir(parents=True, exist_ok=True)
    program = a.build / "bin" / "kf_slam_comparison"
    config = pathlib.Path(__file__).resolve().parents[2] / "config" / "runs" / "kf_slam_demo.ini"

    jobs = [("kf-slam_demo", [demo(a.out)], a.repetitions)]
    jobs += [(f"{n} landmarks", [simulate(a.out, n, seed) for seed in range(1, a.logs + 1)], 1) for n in a.sizes]
    results, groups = {}, []
    for name, logs, repetitions in jobs:
        figure = ["--figure", str(a.out / "kf_slam_time")] if a.sizes and name == jobs[-1][0] else []
        result = measure(program, config, logs, repetitions, a.range_std, extra + figure)
        results[name] = result
        groups.append((name, [trial for log in result["logs"] for trial in log["trials"]]))
    (a.out / "kf_slam.json").write_text(json.dumps(results))

    report = (f"{processor()}, {datetime.date.today()}, range noise {a.range_std} m.\n\n{table(groups)}\n\n"
              f"Last quarter of the frames:\n\n{full_map_table(groups)}\n\nErrors:\n\n{error_table(groups)}\n")
    (a.out / "kf_slam.md").write_text(report)
    print(report)


if __name__ == "__main__":
    main()
