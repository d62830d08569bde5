#!/usr/bin/env python3
"""Follows doc/tutorials/write_your_estimator.md as a reader would: installs slamot into an empty prefix, and outside
the tree runs every `sh` block, compares or writes every file shown, then moves the prefix and runs once more.

With --update the files that the page compares are put into it instead.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

# A comment names what a block is to its file; sh blocks have none.
BLOCK = re.compile(r"(?:<!-- (file|write|contains): (\S+) -->\n)?```(\w+)\n(.*?)```\n", re.DOTALL)


def script_of(page):
    """The page as one bash script."""
    lines = ["set -euo pipefail"]
    for role, name, language, body in BLOCK.findall(page):
        if language == "sh":
            lines.append(body)
        elif role == "file":
            lines.append(f"echo '== {name} is what the page shows'\ndiff -u {name} - <<'END_OF_BLOCK'\n{body}END_OF_BLOCK")
        elif role == "write":
            lines.append(f"echo '== writing {name}'\ncat > {name} <<'END_OF_BLOCK'\n{body}END_OF_BLOCK")
        elif role == "contains":
            lines.append(f"echo '== {name} has the line shown'\ngrep -qF -- '{body.strip()}' {name}")
    return "\n".join(lines) + "\n"


def updated(page, source):
    """The page with its `file` blocks as renaming the originals gives them."""
    def renamed(match):
        role, name, language, _ = match.groups()
        if role != "file":
            return match.group(0)
        original = source / "plugins/dead_reckoning" / name.replace("MyOdometry", "DeadReckoning")
        text = original.read_text().replace("dead_reckoning", "my_odometry").replace("DeadReckoning", "MyOdometry")
        return f"<!-- file: {name} -->\n```{language}\n{text}```\n"
    return BLOCK.sub(renamed, page)


def rows(file):
    return file.read_text().splitlines()[1:]


def check_outputs(folder):
    for run, has_map in (("before", False), ("after", True)):
        out = folder / "my_odometry/out" / run
        summary = json.loads((out / "summary.json").read_text())
        assert summary["estimator"] == "my_odometry", summary["estimator"]
        assert summary["status"] == "complete", summary["status"]
        assert len(rows(out / "trajectory.csv")) > 100, "a short trajectory"
        assert bool(rows(out / "landmarks.csv")) == has_map, f"{run}: landmarks.csv"
    assert "| `map_range` |" in (folder / "my_odometry/my_odometry.md").read_text()


def run_moved(folder, environment):
    """The prefix under another name: nothing may remember where it was installed."""
    moved = folder / "moved prefix"
    (folder / "prefix").rename(moved)
    work = folder / "my_odometry"
    environment = dict(environment, SLAMOT_PLUGIN_PATH=str(work / "build/slamot/plugins"))
    slamot = moved / "bin/slamot"
    listed = subprocess.run([slamot, "plugins"], env=environment, check=True, capture_output=True, text=True).stdout
    for name in ("dead_reckoning", "ekf_slamot", "my_odometry"):
        assert re.search(rf"^{name}\s", listed, re.MULTILINE), f"{name} is not listed:\n{listed}"
    subprocess.run([slamot, "-q", "run", "my_odometry.ini", "demo.rawlog", "-o", "out/moved",
                    "--set", "output.figure=false", "--set", "my_odometry.map_range=20"],
                   cwd=work, env=environment, check=True)
    for file in (moved / "lib").rglob("*.cmake"):
        assert str(folder) not in file.read_text(), f"{file} names where it was installed"
    for name in ("trajectory.csv", "landmarks.csv"):
        assert (work / "out/moved" / name).read_bytes() == (work / "out/after" / name).read_bytes(), name


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", type=Path, default=Path(__file__).resolve().parents[2])
    parser.add_argument("--build", type=Path, help="a finished build folder")
    parser.add_argument("--work", type=Path, help="folder to work in; emptied first")
    parser.add_argument("--flags", default="", help="compiler flags that everything must share, such as sanitizers")
    parser.add_argument("--update", action="store_true", help="put the present files into the page")
    options = parser.parse_args()
    page_file = options.source / "doc/tutorials/write_your_estimator.md"
    page = page_file.read_text()
    if options.update:
        page_file.write_text(updated(page, options.source))
        return
    if not options.build or not options.work:
        parser.error("--build and --work are needed")

    shutil.rmtree(options.work, ignore_errors=True)
    options.work.mkdir(parents=True)
    environment = dict(os.environ, SLAMOT_SOURCE=str(options.source), SLAMOT_BUILD=str(options.build),
                       PREFIX=str(options.work / "prefix"), CXXFLAGS=options.flags)
    for name in ("SLAMOT_PLUGIN_PATH", "LD_LIBRARY_PATH", "DESTDIR"):
        environment.pop(name, None)
    script = options.work / "tutorial.sh"
    script.write_text(script_of(page))
    subprocess.run(["bash", "-x", script], cwd=options.work, env=environment, check=True)
    check_outputs(options.work)
    run_moved(options.work, environment)
    print("install_consumer: all of the page works")


if __name__ == "__main__":
    try:
        main()
    except (AssertionError, subprocess.CalledProcessError) as error:
        sys.exit(f"install_consumer: {error}")
