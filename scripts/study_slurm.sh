#!/usr/bin/env bash
# A study as a Slurm job array: one shard a task, then the merge.
set -euo pipefail

usage() {
    cat <<'TEXT'
study_slurm.sh [--submit] STUDY.ini DB TASKS [options of slamot study]

Prints the two commands that run STUDY.ini as a job array of TASKS shards and then merge them into DB; with --submit
they are run. Each task has its own file DB.shard_k_of_TASKS. The merge comes when all tasks have ended, however they
ended, and says what is missing; submitted again, only that is run. Paths must be seen by all nodes.
Options about all rows (--check, --export, --fill) go to the merge only, those about running to the shards only.
Partition, time, memory: sbatch's own variables (SBATCH_PARTITION, SBATCH_TIMELIMIT, SBATCH_MEM_PER_NODE, ...).
The program is $SLAMOT, else build/release/bin/slamot of this tree, else slamot in PATH.
Example: scripts/study_slurm.sh --submit config/studies/consistency.ini consistency.db 20
TEXT
}
refuse() { echo "study_slurm: $1; see study_slurm.sh --help" >&2; exit 2; }

[[ ${1:-} == --help ]] && { usage; exit 0; }
submit=0
[[ ${1:-} == --submit ]] && { submit=1; shift; }
[[ $# -ge 3 ]] || refuse "expected STUDY.ini DB TASKS"
study=$1 tasks=$3
[[ -f $study ]] || refuse "$study is not there, expected a study file"
[[ $tasks =~ ^[1-9][0-9]*$ ]] || refuse "TASKS is '$tasks', expected a number of at least 1"
study=$(realpath "$study") db=$(realpath -m "$2")
shift 3
source "$(dirname "$0")/study_options.sh"
split_options "$@"
built=$(realpath -m "$(dirname "$0")/../build/release/bin/slamot")
[[ -x $built ]] || built=slamot
slamot=$(command -v "${SLAMOT:-$built}") || refuse "no program ${SLAMOT:-$built}, expected one in SLAMOT, build/release or PATH"
[[ $submit == 0 ]] || command -v sbatch >/dev/null || refuse "sbatch is not there, expected Slurm's commands"

quoted() { [[ $# == 0 ]] || printf ' %q' "$@"; }
run=$(printf '%q -q study %q --db %q.shard_${SLURM_ARRAY_TASK_ID}_of_%q --shard ${SLURM_ARRAY_TASK_ID}/%q%s' \
    "$slamot" "$study" "$db" "$tasks" "$tasks" "$(quoted "${shard_options[@]}")")
merge=$(printf '%q study %q --db %q --merge%s%s' "$slamot" "$study" "$db" \
    "$(for ((k = 1; k <= tasks; ++k)); do printf ' %q' "$db.shard_${k}_of_$tasks"; done)" "$(quoted "${merge_options[@]}")")
array=(sbatch --parsable --job-name=slamot_study --array="1-$tasks" --output="$db.slurm_%a.txt" --wrap "$run")
after=(sbatch --parsable --job-name=slamot_merge --output="$db.slurm_merge.txt" --wrap "$merge")

if [[ $submit == 0 ]]; then
    printf '%q ' "${array[@]}"
    echo
    printf '%q ' "${after[@]}" --dependency=afterany:JOB
    echo
    exit 0
fi
job=$("${array[@]}")
last=$("${after[@]}" --dependency="afterany:$job")
echo "study_slurm: job array $job, then merge $last; output in $db.slurm_*.txt"
