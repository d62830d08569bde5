# Sourced by study_parallel.sh and study_slurm.sh: of the options of slamot study, those for the shards and those
# for the merge, which has all rows, into the arrays shard_options and merge_options.
split_options() {
    shard_options=() merge_options=()
    while [[ $# -gt 0 ]]; do
        local option=$1
        shift
        case $option in
        --check | --export=* | --fill=*) merge_options+=("$option") ;;
        --export) merge_options+=("$option" "${@:1:1}"); shift $(($# > 0)) ;;
        --fill)
            merge_options+=("$option")
            while [[ $# -gt 0 && $1 != -* ]]; do merge_options+=("$1"); shift; done
            ;;
        --retry-failed | --keep=* | --threads=*) shard_options+=("$option") ;;
        --keep | --threads) shard_options+=("$option" "${@:1:1}"); shift $(($# > 0)) ;;
        *) shard_options+=("$option") merge_options+=("$option") ;;
        esac
    done
}
