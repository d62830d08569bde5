#!/usr/bin/env python3
"""Size and times of report.html for a large run: writes an output folder of so many steps and landmarks as `slamot run`
would, and the truth beside it, lets `slamot report` make the page and Chromium open it.

    tests/bench/report_size.py build/release/bin/slamot --steps 100000 --landmarks 10000
"""
import argparse
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "report/browser"))
import chromium

DT, SPEED, PER_STEP = 0.1, 1.0, 10


def write_run(folder, steps, landmarks):
    """A drive along loops through a field of landmarks, ten of them seen at each step; errors like a filter's."""
    draw = random.Random(1)
    side = math.sqrt(landmarks) * 5
    places = [(draw.uniform(0, side), draw.uniform(0, side)) for _ in range(landmarks)]
    grid = {}
    for i, (x, y) in enumerate(places):
        grid.setdefault((int(x // 10), int(y // 10)), []).append(i)
    truth = folder.parent / "large.truth"
    summary = {"program": "slamot", "version": "0.1.0", "status": "complete", "log": "large.rawlog", "truth": str(truth),
               "estimator": "ekf_slamot", "detector": "none", "seed": 1, "config": "[run]\nestimator = ekf_slamot\n",
               "counts": {"landmarks": landmarks, "tracks_at_end": 1}, "drops": [], "warnings": [], "metrics": None,
               "sensors": [{"label": "eye", "x": 0, "y": 0, "theta": 0, "max_range": 10, "field_of_view": 6.283}]}
    (folder / "summary.json").write_text(json.dumps(summary))
    truth.mkdir()
    (truth / "truth.json").write_text("{}")
    with open(truth / "landmarks.csv", "w") as out:
        out.write("id,x,y\n" + "".join(f"{i},{x},{y}\n" for i, (x, y) in enumerate(places)))
    covariances = [f"c_{i}_{j}" for i in range(6) for j in range(i, 6)]
    files = {name: open(folder / f"{name}.csv", "w") for name in
             ("trajectory", "steps", "innovations", "landmarks_history", "tracks", "landmarks")}
    files["trajectory"].write("t,x,y,theta,c_xx,c_xy,c_xt,c_yy,c_yt,c_tt\n")
    files["steps"].write("t,landmarks,tracks,ms_predict,ms_detect,ms_update\n")
    files["innovations"].write("t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis\n")
    files["landmarks_history"].write("t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id\n")
    files["tracks"].write(f"t,track,x,y,vx,vy,ax,ay,{','.join(covariances)},existence,p_cv,p_ca,moving,source_id\n")
    files["landmarks"].write("id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,existence,moving,source_id\n")
    seen, robot_truth, target_truth = {}, ["t,x,y,theta\n"], ["t,x,y,vx,vy,ax,ay,mode\n"]
    for k in range(steps):
        t = f"{1000 + k * DT:.7f}"
        a = k * DT * SPEED / (side / 3)
        x, y = side / 2 + side / 2.2 * math.sin(a * 1.618), side / 2 + side / 2.2 * math.cos(a)
        error = 0.3 * math.sin(k / 500) + draw.gauss(0, 0.05)
        robot_truth.append(f"{t},{x},{y},{math.remainder(a, 6.28318)}\n")
        target_truth.append(f"{t},{x + 5},{y},1,0,0,0,{'ca' if k // 3000 % 2 else 'cv'}\n")
        files["trajectory"].write(f"{t},{x + error},{y - error},{math.remainder(a + 0.01 * error, 6.28318)},0.02,0,0,0.02,0,0.0001\n")
        p = 0.5 + 0.4 * math.sin(k / 300) + draw.gauss(0, 0.02)
        files["tracks"].write(f"{t},0,{x + 5 + error},{y},1,0,0,0,{','.join('0.05' if i == j else '0' for i in range(6) for j in range(i, 6))},1,{p},{1 - p},1,3\n")
        near = [i for dx in (-1, 0, 1) for dy in (-1, 0, 1) for i in grid.get((int(x // 10) + dx, int(y // 10) + dy), ())]
        for i in draw.sample(near, min(PER_STEP, len(near))):
            count = seen.setdefault(i, [0, t, t])
            count[0] += 1
            count[2] = t
            sigma = 0.3 / math.sqrt(count[0]) + 0.02
            files["landmarks_history"].write(f"{t},{i},{places[i][0] + draw.gauss(0, sigma)},{places[i][1] + draw.gauss(0, sigma)},{sigma**2},0,{sigma**2},1,0,{i}\n")
            files["innovations"].write(f"{t},eye,landmark,{i},-1,updated,{draw.gauss(0, 0.1)},{draw.gauss(0, 0.01)},0.01,0,0.0001,{draw.expovariate(0.5)}\n")
        files["steps"].write(f"{t},{len(seen)},1,{0.1 + draw.random() * 0.1},0,{1 + draw.random()}\n")
    for i, (count, first, last) in sorted(seen.items()):
        files["landmarks"].write(f"{i},{places[i][0]},{places[i][1]},0.01,0,0.01,{count},{first},{last},1,0,{i}\n")
    for file in files.values():
        file.close()
    (truth / "robot.csv").write_text("".join(robot_truth))
    (truth / "target_3.csv").write_text("".join(target_truth))
    n = 512
    cells = [1.0 if i == j else math.exp(-abs(i - j) / 60) * draw.uniform(0.7, 1) for i in range(n) for j in range(n)]
    (folder / "correlation.bin").write_bytes(b"SLAMCORR" + struct.pack("<3I", 1, 9 + 2 * len(seen), n) + struct.pack(f"<{n * n}f", *cells))
    return len(seen)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--steps", type=int, default=100000)
    parser.add_argument("--landmarks", type=int, default=10000)
    parser.add_argument("--keep", help="copy of the page")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        run = pathlib.Path(temporary) / "run"
        run.mkdir()
        seen = write_run(run, options.steps, options.landmarks)
        begin = time.monotonic()
        subprocess.run([options.program, "-q", "report", run], check=True)
        print(f"{options.steps} steps, {seen} landmarks seen: made in {time.monotonic() - begin:.1f} s, ", end="")
        page = run / "report.html"
        print(f"{page.stat().st_size / 1e6:.2f} MB", end="")
        if options.keep:
            pathlib.Path(options.keep).write_bytes(page.read_bytes())
        with chromium.Page(page, timeout=300) as browser:
            begin = time.monotonic()
            browser.wait_for_figures()
            print(f", loaded in {browser.load_seconds:.2f} s, all figures {time.monotonic() - begin:.2f} s later; replay draws a frame in ", end="")
            print(browser.evaluate("(() => { const s = document.querySelector('.replay input[type=range]'); const b = performance.now();"
                                   " for (let i = 0; i < 20; ++i) { s.value = s.max - i; s.dispatchEvent(new Event('input')); }"
                                   " return ((performance.now() - b) / 20).toFixed(1); })()"), "ms")
            print(browser.complaints or "the console has nothing to say")


if __name__ == "__main__":
    main()
