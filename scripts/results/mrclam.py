#!/usr/bin/env python3
"""The MRCLAM table: every robot alone, both cores and dead reckoning; fills doc/results/mrclam.md.

Usage: scripts/results/mrclam.py     (SLAMOT_DATASETS names the folder that holds mrclam_6)
"""
import statistics
import tempfile

from common import DATASETS, ROOT, fill, slamot, stamp, summary, table

CASES = {
    "dead reckoning": ["--set", "run.estimator=dead_reckoning"],
    "classic": ["--set", "ekf_slamot.consistency=classic"],
    "invariant": [],
}


def row(name, robot, m):
    """One run's figures; None where there is nothing to measure."""
    landmarks, targets = m.get("landmarks"), m.get("targets") or {}
    seen, every = targets.get("seen"), targets.get("all")
    return {
        "case": name,
        "robot": robot,
        "position RMSE [m]": m["robot"]["position"]["rmse"],
        "heading RMSE [deg]": m["robot"]["heading"]["rmse"] * 57.29577951308232,
        "NEES (3)": m["robot_nees"]["average"],
        "95 % coverage": m["robot_nees"]["coverage"],
        "landmarks RMSE [m]": landmarks["position"]["rmse"] if landmarks else None,
        "targets RMSE [m]": every["position"]["rmse"] if every else None,
        "targets from the robot, seen: RMSE [m]": seen["relative_position"]["rmse"] if seen else None,
        "median [m]": seen["relative_position"]["median"] if seen else None,
        "down-weighted": None,
    }


def cell(value):
    return "" if value is None else f"{value:.3f}" if isinstance(value, float) else value


def main():
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        slamot("import", "mrclam", DATASETS / "mrclam_6", "-o", f"{folder}/logs")
        for case, overrides in CASES.items():
            own = []
            for robot in range(1, 6):
                slamot("run", ROOT / "config/runs/mrclam_ekf.ini", f"{folder}/logs/robot_{robot}.rawlog", "-o",
                       f"{folder}/out", "--set", "output.figure=false", "--set", "output.interval=0", *overrides)
                result = summary(f"{folder}/out")
                figures = row(case, robot, result["metrics"])
                figures["down-weighted"] = result["counts"]["detections_inflated"]
                own.append(figures)
            mean = {key: statistics.mean(r[key] for r in own) if own[0][key] is not None else None
                    for key in own[0] if key not in ("case", "robot")}
            rows += own + [{"case": f"**{case}**", "robot": "**mean**", **mean}]
    header = list(rows[0])
    fill("mrclam.md", "table", table(header, [[cell(r[key]) for key in header] for r in rows]) + "\n\n" + stamp())


main()
