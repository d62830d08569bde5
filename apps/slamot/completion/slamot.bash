# Bash completion for slamot.
_slamot() {
    local current=${COMP_WORDS[COMP_CWORD]}
    if [[ $COMP_CWORD -eq 1 ]]; then
        COMPREPLY=($(compgen -W "simulate import convert info run eval report compare study plugins config --help --version" -- "$current"))
    elif [[ ${COMP_WORDS[1]} == config && $COMP_CWORD -eq 2 ]]; then
        COMPREPLY=($(compgen -W "$(slamot plugins 2>/dev/null | cut -d' ' -f1)" -- "$current"))
    elif [[ $current == -* ]]; then
        COMPREPLY=($(compgen -W "$(slamot "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE -- '--[a-z-]+')" -- "$current"))
    else
        COMPREPLY=($(compgen -f -- "$current"))
    fi
}
complete -o filenames -F _slamot slamot
