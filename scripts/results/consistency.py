#!/usr/bin/env python3
"""Consistency of both cores in paper 1's scenario: fills doc/results/consistency.md.

Usage: scripts/results/consistency.py [runs per case, default 300]
"""
import math
import statistics
import sys
import tempfile

from common import ROOT, fill, slamot, stamp, summary, table

FILES_OFF = [a for key in ("innovations", "landmarks_history", "steps", "correlation", "map", "scene", "rawlog", "figure")
             for a in ("--set", f"output.{key}=false")]


def band(mean, values):
    """Mean with the half width of its 95 % interval."""
    half = 1.96 * statistics.stdev(values) / math.sqrt(len(values))
    return f"{mean:.3g} ± {half:.2g}"


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    config = ROOT / "config/runs/paper1_ekf.ini"
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for scenario in ("paper1", "quiet"):
            results = {"classic": [], "invariant": []}
            for seed in range(1, runs + 1):
                log = f"{folder}/log.rawlog"
                slamot("simulate", ROOT / f"config/scenarios/{scenario}.ini", "-o", log, "--seed", seed)
                for core in results:
                    slamot("run", config, log, "-o", f"{folder}/out", "--set", f"ekf_slamot.consistency={core}", *FILES_OFF)
                    results[core].append(summary(f"{folder}/out")["metrics"])
            for core, metrics in results.items():
                nees = [m["robot_nees"]["average"] for m in metrics]
                target = [m["targets"]["all"]["nees"]["average"] for m in metrics]
                rmse = [m["robot"]["position"]["rmse"] for m in metrics]
                target_rmse = [m["targets"]["all"]["position"]["rmse"] for m in metrics]
                landmark = [m["landmarks"]["position"]["rmse"] for m in metrics]
                rows.append([scenario, core, runs] + [band(statistics.mean(v), v) for v in
                            (nees, target, rmse, target_rmse, landmark)])
    header = ["scenario", "core", "runs", "ANEES robot (3)", "ANEES target (2)", "robot RMSE [m]", "target RMSE [m]",
              "landmark RMSE [m]"]
    fill("consistency.md", "table", table(header, rows) + "\n\n" + stamp())


main()
