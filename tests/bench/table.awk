# Google Benchmark's CSV as a table for people, with the ratio of direct to nested on each machine. Kernels are given in
# processor time, which other work on the computer disturbs less; whole runs in time on the clock, since they run threads.
BEGIN { FS = ","; printf "%-34s %14s %12s\n", "", "time", "Newton steps" }
$1 == "name" { for (i = 1; i <= NF; i++) { gsub(/"/, "", $i); column[$i] = i }; next }
{
  gsub(/"/, ""); name = $1; sub(/\/real_time$/, "", name)
  if ($column["error_occurred"] == "true") { printf "%-34s %s\n", name, "failed: " $column["error_message"]; failed = 1; next }
  time[name] = $column[name ~ /^whole_run/ ? "real_time" : "cpu_time"]
  note = ""
  if ($column["items_per_second"] != "") note = sprintf("%s, %.0f waypoints/s", $column["label"], $column["items_per_second"])
  if ($column["bytes_per_second"] != "") note = sprintf("%.0f MB/s", $column["bytes_per_second"] / 1e6)
  printf "%-34s %11.2f %s %12s  %s\n", name, time[name], $column["time_unit"], steps($column["steps"]), note
}
function steps(n) { return n == "" || n == 0 ? "" : sprintf("%.0f", n) }
END {
  print ""
  n = split("orthoglide hexapod robot_6r mill", machines, " ")
  for (m = 1; m <= n; m++) {
    direct = time[machines[m] "/direct"]; nested = time[machines[m] "/nested"]
    if (direct > 0 && nested > 0)
      printf "%-34s direct takes %.3f of nested's time (1/%.1f)\n", machines[m], direct / nested, nested / direct
  }
  exit failed
}
