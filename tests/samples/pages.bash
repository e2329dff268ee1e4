# Pages of documentation whose quotations are made by running their commands. To be sourced with the program as argument.
#
# In a page
#   - a block ```console holds commands, lines that begin with "$ ", each followed by what it prints;
#   - a block after the line <!-- file PATH --> holds that file, from the top folder.
# Everything else is left as it is. Commands run one after another in a copy of the samples: those of README.md in the top folder,
# those of a sample in its own. A page of the guide has a copy of its own, so that it does not depend on another page.
set -uo pipefail
counterflex=$(realpath "$1")
[ -x "$counterflex" ] || { echo "$1 is not there" >&2; exit 1; }
top=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r "$top/samples" "$work/samples"
mkdir "$work/.bin" && ln -s "$counterflex" "$work/.bin/counterflex"
pages=(README.md programs/guide/*.md samples/*/README.md)
pictures=(samples/orthoglide-groove/{deviation,case-a}.svg)  # commands of a page draw them
for picture in "${pictures[@]}"; do rm -f "$work/$picture"; done

run_command() (
  cd "$work/$1" || exit 1
  PATH=$work/.bin:$PATH NO_COLOR=1 LC_ALL=C bash -c "$2" </dev/null 2>&1
)

# Prints page $1, a path from the top folder, with its quotations generated again.
regenerated() {
  local page=$1 folder line inside='' file=''
  folder=$(dirname "$page")
  if [ "$folder" = programs/guide ]; then
    folder=.guide/$(basename "$page" .md)
    mkdir -p "$work/$folder" && cp -r "$top/samples" "$work/$folder/samples"
  fi
  while IFS= read -r line; do
    case "$inside:$line" in
      ':<!-- file '*' -->') file=${line#'<!-- file '} file=${file%' -->'} ;;
      ':```console') inside=console ;;
      ':```'*) inside=text; if [ -n "$file" ]; then printf '%s\n' "$line"; cat "$top/$file"; inside=file file=''; continue; fi ;;
      *':```') inside='' ;;
      'file:'*) continue ;;
      'console:$ '*) printf '%s\n' "$line"; run_command "$folder" "${line#'$ '}"; continue ;;
      'console:'*) continue ;;
    esac
    printf '%s\n' "$line"
  done <"$top/$page"
}
