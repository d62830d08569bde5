#!/usr/bin/env python3
"""Speed-up of `slamot study` with two threads over one: interleaved pairs of whole studies, each in a fresh file of rows.

A pair is discarded when other processes used more than 4 % of the machine during one of its studies, since then the
ratio tells of them. Prints each pair, then median and range of the ratios of wall time, process start to end."""
import argparse
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

OTHERS_AT_MOST = 0.04  # part of the machine's processor time
CORES = os.cpu_count()


def busy_seconds():
    """Of all cores together, since the machine started; proc(5)."""
    user, nice, system, idle, waiting, *rest = map(int, pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:9])
    return (user + nice + system + sum(rest)) / os.sysconf("SC_CLK_TCK")


def own_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def study_once(arguments, threads, folder):
    """Wall time [s], the part of the machine that others used, and the study's own line about its times."""
    for file in folder.iterdir():
        file.unlink()
    busy, own, begin = busy_seconds(), own_seconds(), time.monotonic()
    done = subprocess.run([*arguments, "--db", folder / "rows.db", "--threads", str(threads)], capture_output=True,
                          text=True)
    wall = time.monotonic() - begin
    if done.returncode != 0:
        sys.exit(f"study_speedup: {done.stderr.strip()}")
    others = (busy_seconds() - busy - (own_seconds() - own)) / (CORES * wall)
    return wall, max(others, 0), done.stdout.splitlines()[0]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("study", help="study file without recorded logs")
    options.add_argument("slamot", help="the program, of a release build")
    options.add_argument("--pairs", type=int, default=6, help="pairs that count (default 6)")
    options.add_argument("--replicates", type=int, help="instead of the study's own number")
    options.add_argument("--tries", type=int, help="pairs made at most (default: three times those that count)")
    chosen = options.parse_args()
    arguments = [chosen.slamot, "study", chosen.study]
    if chosen.replicates:
        arguments += ["--replicates", str(chosen.replicates)]

    ratios = []
    with tempfile.TemporaryDirectory(prefix="slamot_speedup_") as folder:
        for number in range(chosen.tries or 3 * chosen.pairs):
            if len(ratios) == chosen.pairs:
                break
            order = (1, 2) if number % 2 == 0 else (2, 1)
            of = {threads: study_once(arguments, threads, pathlib.Path(folder)) for threads in order}
            counts = max(others for _, others, _ in of.values()) <= OTHERS_AT_MOST
            ratio = of[1][0] / of[2][0]
            print(f"{'counts' if counts else 'discarded'}: 1 thread {of[1][0]:.2f} s, 2 threads {of[2][0]:.2f} s, ratio "
                  f"{ratio:.3f}; others {of[1][1]:.1%} and {of[2][1]:.1%} of the machine", flush=True)
            for threads in (1, 2):
                print(f"  {of[threads][2]}", flush=True)
            if counts:
                ratios.append(ratio)
    if not ratios:
        sys.exit("study_speedup: no pair counts: the machine is busy with other things")
    print(f"median {statistics.median(ratios):.2f}, range {min(ratios):.2f} to {max(ratios):.2f}, of {len(ratios)} pairs on "
          f"{CORES} cores")


if __name__ == "__main__":
    main()
