#!/usr/bin/env bash
# Everything that is tested: a release build with warnings as errors and all tests, then the unit and conformance
# tests again under the address and undefined-behaviour sanitizers. SLAMOT_TEST_SANITIZERS=0 leaves the second out.
set -euo pipefail
cd "$(dirname "$0")/.."
trap 'echo "test: failed at: $BASH_COMMAND" >&2' ERR

echo "== packages"
scripts/install_packages.sh build run test study
echo "== release build, warnings as errors"
cmake --preset ci >/dev/null
cmake --build --preset ci
if [ "${SLAMOT_TEST_SANITIZERS:-1}" != 0 ]; then
    echo "== sanitizer build: unit and conformance tests"
    cmake --preset asan >/dev/null
    cmake --build --preset asan
    ctest --preset asan -j "$(nproc)" -L 'core|rawlog|sim|eval|report|run|study|conformance|plugins' -LE long --quiet \
        -O build/asan/ctest.log || { tail -n 60 build/asan/ctest.log; exit 1; }
    tail -n 4 build/asan/ctest.log
fi
echo "== all tests"
ctest --preset ci -j "$(nproc)" -LE nightly
