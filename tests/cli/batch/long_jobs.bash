# Shared by tests of batches: three short programs a.ngc, b.ngc and c.ngc, one that takes a while (long.ngc), and jobs files. Source it
# behind support.bash.
for name in a b c; do sed "s/^M5/X1${#name}\nM5/" part.ngc >"$name.ngc"; done
for ((i = 0; i < 5000; ++i)); do echo "G1 X$((i % 97)).$((i % 7)) Y$((i % 89)).5 F600"; done |
  cat <(printf 'G21 G90 G54\nG0 X0 Y0 Z0\n') - >long.ngc
jobs() { printf 'format = "counterflex-jobs 1"\noutput = "done"\nmachine = "mill.toml"\nforce = [100, 0, 0]\n%s\n' "$1" >jobs.toml; }
each() { printf '[[job]]\nprogram = "%s"\n%s\n' "$1" "${2:-}"; }
nothing_temporary() { ! find "$1" -name '*.tmp' | grep . || fail "left behind"; }
