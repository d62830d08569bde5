#!/usr/bin/env bash
# Installs sections of scripts/packages.txt: install_packages.sh build run [test ...]
set -euo pipefail
cd "$(dirname "$0")/.."

wanted=$(awk -v sections=" $* " '
    /^# \[/ { name = $2; gsub(/[][]/, "", name); take = index(sections, " " name " "); next }
    /^#/    { next }
    take    { print }' scripts/packages.txt | tr -s ' \n' ' ')
missing=""
for package in $wanted; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing="$missing $package"
done
if [ -z "$missing" ]; then
    echo "packages: all there ($*)"
    exit 0
fi

command -v apt-get >/dev/null || { echo "packages: this is no Debian system (no apt-get); install:$missing" >&2; exit 1; }
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "packages: need root or sudo to install:$missing" >&2; exit 1; }
    as_root=sudo
fi
echo "packages: installing$missing"
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -qq || { echo "packages: apt-get update failed (is there a network?)" >&2; exit 1; }
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
    { echo "packages: apt-get could not install:$missing" >&2; exit 1; }
