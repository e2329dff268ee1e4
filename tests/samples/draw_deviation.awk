# Two panels over y along the cut: above, the components of the deviation before (mm); below, its size after (um).
# Columns are found by their names. The first file is the original's report, the second the corrected program's.

function square(v) { return v * v }
function px(y) { return left + (y + 80) / 220 * width }
function upper(d) { return top1 + (1 - d) / 2 * height1 }
function lower(um) { return top2 + (6 - um) / 6 * height2 }
function text(x, y, class, anchor, what) {
  printf "<text x=\"%.1f\" y=\"%.1f\" class=\"%s\" text-anchor=\"%s\">%s</text>\n", x, y, class, anchor, what
}
function line(x1, y1, x2, y2, class) {
  printf "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" class=\"%s\"/>\n", x1, y1, x2, y2, class
}

BEGIN { left = 70; width = 590; top1 = 50; height1 = 210; top2 = 318; height2 = 90 }
FNR == 1 { file++; for (i = 1; i <= NF; i++) column[$i] = i; next }
$column["line"] != 9 { next }
file == 1 {
  y = $column["y_mm"]; n++
  for (c = 1; c <= 3; c++) {
    d = $column["before_d" substr("xyz", c, 1) "_mm"]
    curve[c] = curve[c] sprintf("%s%.1f,%.1f", n == 1 ? "" : " ", px(y), upper(d)); last[c] = d
  }
}
file == 2 {
  m++; at[m] = $column["y_mm"]
  after[m] = 1000 * sqrt(square($column["after_dx_mm"]) + square($column["after_dy_mm"]) + square($column["after_dz_mm"]))
}

END {
  frame()
  before_panel()
  after_panel()
  print "</svg>"
}

function frame() {
  print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 460\" width=\"720\" height=\"460\" role=\"img\""
  print "     aria-label=\"Deviation of the tool tip along the groove, before and after correction\">"
  print "<style>"
  print "  text { font: 13px system-ui, 'DejaVu Sans', sans-serif; fill: #3d444d }"
  print "  .title { font-weight: 600; font-size: 14px; fill: #1f2328 }"
  print "  .page { fill: #ffffff; stroke: #d1d9e0 } .grid { stroke: #e3e8ed } .zero { stroke: #818b98 }"
  print "  .limit { stroke: #b42318; stroke-dasharray: 6 4; stroke-width: 1.5 } .limit-text { fill: #b42318 }"
  print "  .largest { stroke: #6e7781; stroke-dasharray: 2 3; stroke-width: 1.5 }"
  print "  polyline { fill: none; stroke-width: 2.5; stroke-linejoin: round }"
  print "  .x { stroke: #0b62d6 } .y { stroke: #b35900 } .z { stroke: #1a7f37 } .dot { fill: #6639ba }"
  print "  .xt { fill: #0b62d6 } .yt { fill: #b35900 } .zt { fill: #1a7f37 } .xt, .yt, .zt { font-weight: 600 }"
  print "  @media (prefers-color-scheme: dark) {"
  print "    text { fill: #b7bfc8 } .title { fill: #f0f6fc }"
  print "    .page { fill: #0d1117; stroke: #3d444d } .grid { stroke: #262c36 } .zero { stroke: #7d8590 }"
  print "    .limit { stroke: #ff7b72 } .limit-text { fill: #ff7b72 } .largest { stroke: #9198a1 } .dot { fill: #c297ff }"
  print "    .x { stroke: #58a6ff } .y { stroke: #f0a040 } .z { stroke: #4ac26b }"
  print "    .xt { fill: #58a6ff } .yt { fill: #f0a040 } .zt { fill: #4ac26b }"
  print "  }"
  print "</style>"
  print "<rect x=\"0.5\" y=\"0.5\" width=\"719\" height=\"459\" rx=\"8\" class=\"page\"/>"
}

function before_panel(  d, c) {
  text(left - 44, 32, "title", "start", "Before: deviation of the tool tip, mm")
  for (d = -1; d < 1.1; d += 0.5) {
    line(left, upper(d), left + width, upper(d), d * d < 1e-9 ? "zero" : "grid")
    text(left - 8, upper(d) + 4, "", "end", sprintf("%.1f", d))
  }
  for (c = 1; c <= 3; c++) {
    printf "<polyline points=\"%s\" class=\"%s\"/>\n", curve[c], substr("xyz", c, 1)
    text(px(126.35) + 7, upper(last[c]) + 4, substr("xyz", c, 1) "t", "start", substr("xyz", c, 1))
  }
}

function after_panel(  um, y, k) {
  text(left - 44, top2 - 26, "title", "start", "After: size of the model residual, \302\265m")
  for (um = 0; um <= 6; um += 2) {
    line(left, lower(um), left + width, lower(um), um == 0 ? "zero" : "grid")
    text(left - 8, lower(um) + 4, "", "end", um)
  }
  line(left, lower(1000 * tolerance), left + width, lower(1000 * tolerance), "limit")
  text(left + width - 4, lower(1000 * tolerance) - 5, "limit-text", "end", sprintf("tolerance %g \302\265m", 1000 * tolerance))
  line(left, lower(1000 * largest), left + width, lower(1000 * largest), "largest")
  text(left + 6, lower(1000 * largest) + 15, "", "start", sprintf("largest between the points %.1f \302\265m", 1000 * largest))
  for (k = 1; k <= m; k++) printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" class=\"dot\"/>\n", px(at[k]), lower(after[k])
  for (y = -50; y <= 100; y += 50) {
    line(px(y), lower(0), px(y), lower(0) + 5, "zero")
    text(px(y), lower(0) + 19, "", "middle", y)
  }
  text(left + width, lower(0) + 38, "", "end", "y along the groove, mm; dots: the points of the corrected program")
}
