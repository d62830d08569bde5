#!/usr/bin/env bash
# A study over GNU parallel: one shard a job, then the merge.
set -euo pipefail

usage() {
    cat <<'TEXT'
study_parallel.sh STUDY.ini DB JOBS [options of slamot study]

Runs STUDY.ini in JOBS shards at the same time, each with its own file DB.shard_k_of_JOBS, and merges them into DB.
Options about all rows (--check, --export, --fill) go to the merge only, those about running to the shards only.
The shards' files stay: the same command after a crash does only the rest. Needs the package `parallel`.
The program is $SLAMOT, else build/release/bin/slamot of this tree, else slamot in PATH.
Example: scripts/study_parallel.sh config/studies/consistency.ini consistency.db 2 --short
TEXT
}
refuse() { echo "study_parallel: $1; see study_parallel.sh --help" >&2; exit 2; }

[[ ${1:-} == --help ]] && { usage; exit 0; }
[[ $# -ge 3 ]] || refuse "expected STUDY.ini DB JOBS"
study=$1 db=$2 jobs=$3
shift 3
source "$(dirname "$0")/study_options.sh"
split_options "$@"
[[ -f $study ]] || refuse "$study is not there, expected a study file"
[[ $jobs =~ ^[1-9][0-9]*$ ]] || refuse "JOBS is '$jobs', expected a number of at least 1"
command -v parallel >/dev/null || refuse "GNU parallel is not there (package parallel)"
built=$(dirname "$0")/../build/release/bin/slamot
[[ -x $built ]] || built=slamot
slamot=${SLAMOT:-$built}
command -v "$slamot" >/dev/null || refuse "no program $slamot, expected one in SLAMOT, build/release or PATH"

shards=()
for ((k = 1; k <= jobs; ++k)); do shards+=("$db.shard_${k}_of_$jobs"); done
parallel --plain --quote --jobs "$jobs" "$slamot" -q study "$study" --db "$db.shard_{}_of_$jobs" \
    --shard "{}/$jobs" "${shard_options[@]}" ::: $(seq "$jobs") ||
    { echo "study_parallel: a shard did not end well; the same command does the rest" >&2; exit 1; }
"$slamot" study "$study" --db "$db" --merge "${shards[@]}" "${merge_options[@]}"
