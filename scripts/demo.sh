#!/usr/bin/env bash
# From a fresh Debian 12 to a first result: installs packages, builds the release preset, makes a log and runs it.
set -euo pipefail
cd "$(dirname "$0")/.."
trap 'echo "demo: failed at: $BASH_COMMAND" >&2' ERR

echo "== 1/4 packages"
scripts/install_packages.sh build run
echo "== 2/4 build (build/release; hundreds of files the first time)"
cmake --preset release -DSLAMOT_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release
slamot=build/release/bin/slamot
echo "== 3/4 a simulated log: a robot among landmarks and movers"
mkdir -p out
$slamot simulate config/scenarios/demo.ini -o out/demo.rawlog
echo "== 4/4 the main job: robot, map and movers from odometry and range-bearing observations"
$slamot run config/runs/demo.ini out/demo.rawlog -o out/demo
echo "report: out/demo/report.html   picture: out/demo/overview.png   summary: out/demo/summary.json"
