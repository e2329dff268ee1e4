# Shared by the tests of the command line. A test is a script that sources this with the program, the JSON reader and, where it
# has faults, the library that makes them (faulty_io.cpp) as its arguments; it works in a folder of its own, which holds copies of data/.
set -uo pipefail
counterflex=$(realpath "$1") json_value=$(realpath "$2")
faulty_io=$(realpath "${3:-$1}")
inputs=$(cd "$(dirname "${BASH_SOURCE[0]}")/data" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$inputs"/* "$work"
cd "$work" || exit 1
unset "${!COUNTERFLEX_@}"  # settings of the user who runs the tests
failures=0 sentence=''

it() { sentence=$1; }

fail() {
  printf 'FAILED: %s: %s\n' "$sentence" "$1"
  failures=$((failures + 1))
}

# Runs counterflex with the arguments after the status $1 that it must have; out and err hold its streams.
runs() {
  local expected=$1 status
  shift
  "$counterflex" "$@" >out 2>err </dev/null
  status=$?
  [ "$status" = "$expected" ] || fail "status $status instead of $expected of 'counterflex $*': $(head -c 600 err)"
}

says() { grep -qF -e "$2" "$1" || fail "'$2' is not in $1: $(head -c 600 "$1")"; }
says_not() { ! grep -qF -e "$2" "$1" || fail "'$2' is in $1"; }
is_empty() { [ ! -s "$1" ] || fail "$1 is not empty: $(head -c 300 "$1")"; }
is_there() { [ -s "$1" ] || fail "$1 is missing or empty"; }
is_not_there() { [ ! -e "$1" ] || fail "$1 is there"; }
same() { cmp -s "$1" "$2" || fail "$1 and $2 differ"; }

# The value at JSON pointer $2 of the file $1 is $3.
has() {
  local value
  value=$("$json_value" "$2" <"$1" 2>&1) || { fail "$1: $value"; return; }
  [ "$value" = "$3" ] || fail "$2 of $1 is $value instead of $3"
}

# Only the inputs and the files of this harness.
nothing_written() {
  local extra
  extra=$(ls -A | grep -vxF -e "$(ls "$inputs")" -e out -e err)
  [ -z "$extra" ] || { fail "left behind: $extra"; rm -rf -- $extra; }
}

finish() {
  [ "$failures" = 0 ] && { echo "all as it should be"; exit 0; }
  echo "$failures failed"
  exit 1
}

# turned.toml: a rigid machine whose frame is shifted, and turned about all axes.
turned_machine() {
  cat >turned.toml <<'TOML'
format = "counterflex-machine 1"
name = "turned"
controlled = ["x", "y", "z"]
[limits]
max_correction_mm = 10
[program]
tool_change_moves = []
[work.G54]
xyz_mm = [0, 0, 0]
datum = "machine"
[[chain]]
name = "axes"
errors.frame = { xyz_mm = [0.5, -0.25, 0.125], rpy_deg = [0.02, -0.03, 0.1] }
elements = [
  { error = "frame" },
  { actuator = "prismatic", axis = "x", min_mm = -5000, max_mm = 5000 },
  { actuator = "prismatic", axis = "y", min_mm = -5000, max_mm = 5000 },
  { actuator = "prismatic", axis = "z", min_mm = -5000, max_mm = 5000 },
]
TOML
}
