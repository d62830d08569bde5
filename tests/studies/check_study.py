#!/usr/bin/env python3
"""Runs a study in a folder of its own and looks at its checks.

    check_study.py PROGRAM STUDY [--must-fail NAME,...] [-- further arguments of `slamot study`]

Exit 0 when all checks passed but those named, which must have failed; 77 (skipped) when the study's data are not there.
"""
import re
import subprocess
import sys
import tempfile

program, study, *rest = sys.argv[1:]
must_fail = set()
if rest[:1] == ["--must-fail"]:
    must_fail, rest = set(rest[1].split(",")), rest[2:]
further = rest[1:] if rest[:1] == ["--"] else rest

with tempfile.TemporaryDirectory() as folder:
    done = subprocess.run([program, "-q", "study", study, "--db", f"{folder}/rows.db", "--threads", "2", "--check", *further],
                          capture_output=True, text=True)
print(done.stdout, done.stderr, sep="\n")
if "nothing remains to run" in done.stderr:
    print("skipped: the data are not there")
    sys.exit(77)
results = {name: state.lower() for state, name in
           re.findall(r"^(passed|FAILED|not checked) +(\S+)$", done.stdout, flags=re.MULTILINE)}
failed = {name for name, result in results.items() if result == "failed"}
checked = failed | {name for name, result in results.items() if result == "passed"}
expected_code = 1 if must_fail else 0
if not checked or failed != must_fail or done.returncode != expected_code:
    print(f"failed: {sorted(failed)}, expected {sorted(must_fail)}; exit code {done.returncode}, expected {expected_code}")
    sys.exit(1)
