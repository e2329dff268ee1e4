# bash completion of counterflex

_counterflex_words() {
  local forces='--forces --force --load-scale --air-above' config='--config --no-config --print-config'
  local reading="--machine --dialect --units --integer-words --arc-centres --evaluate --expand-subprograms --work --tool-table --tool-length $config"
  local program="$reading --tolerance-mm --method --max-correction-mm --accept-partial --decimals --threads"
  case $1 in
    compensate) echo "$program $forces --blend-mm --output --number-pieces --plot --report --force-overwrite --min-block-ms --json --quiet --verbose --help" ;;
    predict | verify) echo "$program $forces --blend-mm --plot --report --force-overwrite --min-block-ms --json --quiet --verbose --help" ;;
    watch) echo "$program $forces --blend-mm --output --number-pieces --plot --report --force-overwrite --min-block-ms --once --pattern --json --quiet --verbose --help" ;;
    compare) echo "--name --report --force-overwrite --json --quiet --verbose --help" ;;
    analyze) echo "--machine --at --tool --force --full --hold --curve --output --force-overwrite --method $config --json --quiet --verbose --help" ;;
    forces) echo "$reading $forces --output --force-overwrite --materials --json --quiet --verbose --help" ;;
    check) echo "$reading --json --quiet --verbose --help" ;;
    batch) echo "--resume --shard --merge --estimate --threads --force-overwrite --json --quiet --verbose --help" ;;
    *) echo "compensate predict verify compare analyze forces check batch watch --version --help" ;;
  esac
}

# The command whose options are completed, by the first word: a program alone is compensated.
_counterflex_command() {
  if [[ ($1 == - || $1 != -*) && " $(_counterflex_words '') " != *" $1 "* ]]; then echo compensate; else echo "$1"; fi
}

_counterflex() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} values=''
  COMPREPLY=()
  case $previous in
    --method) values='direct nested linear' ;;
    --dialect) values='auto linuxcnc grbl fanuc haas mach3 siemens heidenhain' ;;
    --integer-words) values='units increments' ;;
    --arc-centres) values='incremental absolute' ;;
    --units) values='mm inch' ;;
    -m | --machine | --tool-table | --config | -f | --forces | -o | --output | --report | --plot) return ;;  # files: readline completes them
    *) if [[ $COMP_CWORD -eq 1 || $current == -* ]]; then
         values=$(_counterflex_words "$([ "$COMP_CWORD" -gt 1 ] && _counterflex_command "${COMP_WORDS[1]}")")
       fi ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current")
}

complete -o default -F _counterflex counterflex
