"""What the result scripts share: running slamot and reading what it says."""
import json
import os
import pathlib
import platform
import subprocess
import datetime

ROOT = pathlib.Path(__file__).resolve().parents[2]
SLAMOT = pathlib.Path(os.environ.get("SLAMOT", ROOT / "build/release/bin/slamot"))
DATASETS = pathlib.Path(os.environ.get("SLAMOT_DATASETS", ROOT / "../shared/datasets"))


def slamot(*arguments):
    """Runs the program quietly; a failure shows what it said."""
    done = subprocess.run([str(SLAMOT), "-q", *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"slamot {' '.join(map(str, arguments))}: {done.stderr.strip()}")


def summary(folder):
    return json.loads((pathlib.Path(folder) / "summary.json").read_text())


def table(header, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def stamp():
    """When and on what a result was measured."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")),
                 platform.machine())
    return f"Measured on {datetime.date.today()}, {model}, {os.cpu_count()} cores."


def fill(page, name, text):
    """Replaces what stands between `<!-- name -->` and `<!-- end -->` in a page of doc/results/."""
    path = ROOT / "doc/results" / page
    old = path.read_text()
    begin, end = f"<!-- {name} -->\n", "<!-- end -->"
    start = old.index(begin) + len(begin)
    path.write_text(old[:start] + text + "\n" + old[old.index(end, start):])
