#!/usr/bin/env python3
"""Consistency of both cores in paper 1's scenario: fills doc/results/consistency.md.

Usage: scripts/results/consistency.py [runs per case, default 300]
"""
import concurrent.futures
import math
import os
import statistics
import sys
import tempfile

from common import ROOT, fill, slamot, stamp, summary, table

FILES_OFF = [a for key in ("innovations", "landmarks_history", "steps", "correlation", "map", "scene", "rawlog", "figure")
             for a in ("--set", f"output.{key}=false")]


CORES = ("classic", "invariant")


def band(values):
    """Mean with the half width of its 95 % interval, and the median: runs are heavy-tailed."""
    half = 1.96 * statistics.stdev(values) / math.sqrt(len(values))
    return f"{statistics.mean(values):.3g} ± {half:.2g} ({statistics.median(values):.3g})"


def one_seed(scenario, seed):
    """Metrics of both cores on one log."""
    with tempfile.TemporaryDirectory() as folder:
        slamot("simulate", ROOT / f"config/scenarios/{scenario}.ini", "-o", f"{folder}/log.rawlog", "--seed", seed)
        metrics = {}
        for core in CORES:
            slamot("run", ROOT / "config/runs/paper1_ekf.ini", f"{folder}/log.rawlog", "-o", f"{folder}/out", "--set",
                   f"ekf_slamot.consistency={core}", *FILES_OFF)
            metrics[core] = summary(f"{folder}/out")["metrics"]
        return metrics


def figures(metrics):
    """Of one run, in the order of the table's columns."""
    target = metrics["targets"]["all"]
    return (metrics["robot_nees"]["average"], target["nees"]["average"], metrics["robot"]["position"]["rmse"],
            target["position"]["rmse"], metrics["landmarks"]["position"]["rmse"])


def main():
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 300
    rows = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for scenario in ("paper1", "quiet"):
            results = list(pool.map(lambda seed: one_seed(scenario, seed), range(1, runs + 1)))
            for core in CORES:
                columns = list(zip(*(figures(metrics[core]) for metrics in results)))
                rows.append([scenario, core, runs] + [band(column) for column in columns])
    header = ["scenario", "core", "runs", "ANEES robot (3)", "ANEES target (2)", "robot RMSE [m]", "target RMSE [m]",
              "landmark RMSE [m]"]
    fill("consistency.md", "table", table(header, rows) + "\n\n" + stamp())


main()
