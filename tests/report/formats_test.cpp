#include "counterflex/report/formats.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "counterflex/files/file_reader.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

namespace {

Compensation small_compensation() {
  Compensation c;
  c.text = "G21 G0 X1\n";
  c.waypoints = {cut(1, 4, 100, Vector3(0, 0.3, -0.4))};
  c.waypoints[0].s = 100 * mm;
  c.waypoints[0].p_MT = Vector3(1, 2, 3) * mm;
  c.left_alone = {{5, "exact stop: not split"}};
  c.counts.inserted_blocks = 2;
  c.corrected_moves = 3;
  c.other_moves = {.grouped = 1, .held = 1};
  c.largest_correction = 0.5 * mm;
  c.largest_correction_line = 4;
  return c;
}

std::string csv_of(const std::vector<Waypoint>& waypoints, const CsvColumns& columns) {
  std::size_t next_index = 0;
  return csv_header() + csv_rows(waypoints, columns, next_index);
}

}  // namespace

TEST_CASE("the JSON of a compensation has every key, in this order") {
  const MadeUpRun run;
  RunReport report = compensated(run, small_compensation());
  FileReader program = FileReader::of_bytes(made_up_program);
  add_texts(report, program);
  const std::string hash_a(64, 'a'), hash_b(64, 'b');
  CHECK(to_json(report) == R"({
  "schema": "counterflex-report 1",
  "tool": "counterflex 0.1.0",
  "command": "compensate",
  "verdict": "PARTLY",
  "verdict_reason": "62 % of the cutting length, 2 feed moves of unknown deviation",
  "machine": "Mill",
  "inputs": {
    "program": {
      "path": "made_up.ngc",
      "sha256": ")" + hash_a + R"("
    },
    "machine": {
      "path": "mill.toml",
      "sha256": ")" + hash_b + R"("
    }
  },
  "output": null,
  "options": {
    "tolerance-mm": 0.005,
    "method": "direct",
    "json": false
  },
  "failure": null,
  "summary": {
    "before": {
      "max_mm": 0.5,
      "rms_mm": 0.5,
      "mean_mm": 0.5,
      "p95_mm": 0.5,
      "max_line": 4,
      "max_axis_mm": [0.0, 0.3, 0.4],
      "max_rotation_deg": 0.0,
      "max_along_mm": 0.0,
      "max_across_mm": 0.3,
      "max_tool_axis_mm": 0.4
    },
    "after": {
      "max_mm": 0.005,
      "rms_mm": 0.005,
      "mean_mm": 0.005,
      "p95_mm": 0.005,
      "max_line": 4,
      "max_axis_mm": [0.0, 0.003, 0.004],
      "max_rotation_deg": 0.0,
      "max_along_mm": 0.0,
      "max_across_mm": 0.003,
      "max_tool_axis_mm": 0.004
    },
    "sources": {
      "geometry": {
        "max_mm": 0.125,
        "rms_mm": 0.125,
        "mean_mm": 0.125,
        "p95_mm": 0.125,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.075, 0.1],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.075,
        "max_tool_axis_mm": 0.1
      },
      "load": {
        "max_mm": 0.25,
        "rms_mm": 0.25,
        "mean_mm": 0.25,
        "p95_mm": 0.25,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.15, 0.2],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.15,
        "max_tool_axis_mm": 0.2
      },
      "gravity": null,
      "superposition": {
        "max_mm": 0.375,
        "rms_mm": 0.375,
        "mean_mm": 0.375,
        "p95_mm": 0.375,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.225, 0.3],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.225,
        "max_tool_axis_mm": 0.3
      },
      "preloads": null,
      "at_worst": {
        "line": 4,
        "place_mm": [1.0, 2.0, 3.0],
        "geometry_mm": [0.0, 0.075, -0.1],
        "load_mm": [0.0, 0.15, -0.2],
        "gravity_mm": null,
        "preloads_mm": null,
        "superposition_mm": [0.0, 0.225, -0.3],
        "before_mm": [0.0, 0.3, -0.4]
      }
    },
    "sensitivity": {
      "force_plus_30": {
        "max_mm": 0.08,
        "rms_mm": 0.08,
        "mean_mm": 0.08,
        "p95_mm": 0.08,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.048, 0.064],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.048,
        "max_tool_axis_mm": 0.064
      },
      "force_minus_30": {
        "max_mm": 0.07,
        "rms_mm": 0.07,
        "mean_mm": 0.07,
        "p95_mm": 0.07,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.042, 0.056],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.042,
        "max_tool_axis_mm": 0.056
      },
      "without_force": {
        "max_mm": 0.25,
        "rms_mm": 0.25,
        "mean_mm": 0.25,
        "p95_mm": 0.25,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.15, 0.2],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.15,
        "max_tool_axis_mm": 0.2
      }
    },
    "air": {
      "max_mm": 0.25,
      "line": 4
    },
    "correction": {
      "max_mm": 0.5,
      "line": 4
    },
    "corrected_percent": 100.0,
    "path_mm": 100.0,
    "common_shift": null,
    "tool_deviations": [
      {
        "tool": 0,
        "diameter_mm": null,
        "flute_mm": null,
        "before": {
          "tip_mm": 0.5,
          "rim_mm": null,
          "flank_mm": null,
          "tilt_deg": 0.0,
          "line": 4
        },
        "after": {
          "tip_mm": 0.005,
          "rim_mm": null,
          "flank_mm": null,
          "tilt_deg": 0.0,
          "line": 4
        }
      }
    ]
  },
  "feed_moves": {
    "count": 3,
    "within": 1,
    "missed": 0,
    "unknown": 2,
    "unknown_length": 0,
    "length_mm": 161.1803399,
    "within_mm": 100.0,
    "worst_mm": 0.0,
    "worst_line": 4
  },
  "forces": {
    "largest_N": 50.0,
    "largest_Nm": 2.0,
    "ramps": 1,
    "jumps": 0,
    "largest_step_N": 50.0,
    "without_force": {
      "moves": 0,
      "length_mm": 0.0,
      "reasons": [],
      "rows": []
    }
  },
  "loads": null,
  "blocks": {
    "total": 6,
    "moves": 5,
    "corrected": 3,
    "corrected_in_part": 0,
    "grouped": 1,
    "held": 1,
    "not_corrected": 0,
    "inserted": 2,
    "left_alone_count": 1,
    "left_alone": [
      {
        "line": 5,
        "why": "exact stop: not split"
      }
    ]
  },
  "text": {
    "blocks_before": 6,
    "blocks_after": 8,
    "bytes_before": 65,
    "bytes_after": 10
  },
  "control": {
    "short_blocks": {
      "limit_ms": 2.0,
      "count": 0,
      "first_line": null,
      "shortest_ms": null,
      "shortest_line": null
    },
    "lines": {
      "limit": 255,
      "longest": 9,
      "longest_line": 1,
      "near_limit": 0
    },
    "path_tolerances": [],
    "plunges": 0,
    "rapids": 2
  },
  "assumptions": {
    "work": "Program coordinates were taken as machine coordinates: the machine file has no work offsets.",
    "datum": "The machine frame was assumed to be set independently of this machine's errors: no datum is stated.",
    "not_modelled": ["backlash and friction: the tip differs where an axis reverses", "heat: growth of spindle and frame, from the first part of the day to the last", "part and fixture: their bending and clamping", "dynamics: following error, rounded corners, chatter", "the control's own corrections: pitch, straightness and volumetric tables; errors that they remove must not be in the machine file"]
  },
  "sanity": [],
  "warning_count": 0,
  "warnings": [],
  "worst": [
    {
      "line": 4,
      "before_mm": 0.5,
      "after_mm": 0.005,
      "s_mm": 100.0,
      "place_mm": [1.0, 2.0, 3.0],
      "force_N": 50.0,
      "causes": {
        "geometry_mm": 0.125,
        "load_mm": 0.25,
        "gravity_mm": null,
        "preloads_mm": null,
        "discrepancy_mm": 0.125
      },
      "text": "G1 X100 F600",
      "tool": 0,
      "operation": ""
    }
  ],
  "operations": [
    {
      "tool": 0,
      "operation": "",
      "first_line": 4,
      "last_line": 4,
      "moves": 1,
      "length_mm": 100.0,
      "corrected_percent": 100.0,
      "before": {
        "max_mm": 0.5,
        "rms_mm": 0.5,
        "mean_mm": 0.5,
        "p95_mm": 0.5,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.3, 0.4],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.3,
        "max_tool_axis_mm": 0.4
      },
      "after": {
        "max_mm": 0.005,
        "rms_mm": 0.005,
        "mean_mm": 0.005,
        "p95_mm": 0.005,
        "max_line": 4,
        "max_axis_mm": [0.0, 0.003, 0.004],
        "max_rotation_deg": 0.0,
        "max_along_mm": 0.0,
        "max_across_mm": 0.003,
        "max_tool_axis_mm": 0.004
      }
    }
  ],
  "units": {
    "program": "mm",
    "shown": "um"
  }
}
)");
}

TEST_CASE("lengths are shown in inches of an inch program, else in mm of a machine that turns joints") {
  RunReport report;
  CHECK(contains(to_json(report), "\"program\": \"mm\",\n    \"shown\": \"um\""));
  report.units.revolute = true;
  CHECK(contains(to_json(report), "\"program\": \"mm\",\n    \"shown\": \"mm\""));
  report.units.program = LengthUnit::inches;
  CHECK(contains(to_json(report), "\"program\": \"inch\",\n    \"shown\": \"inch\""));
}

TEST_CASE("the JSON of a failure has the failure, and null for unsolved results") {
  const MadeUpRun run;
  Compensation none;
  none.failure = Failure{ErrorKind::limit, 4, "too far"};
  RunReport report = compensated(run, none);
  CHECK(report.error_kind == ErrorKind::limit);
  report.exit_status = 6;
  const std::string json = to_json(report);
  CHECK(contains(json, "\"failure\": {\n    \"exit\": 6,\n    \"line\": 4,\n    \"what\": \"too far\"\n  }"));
  CHECK(contains(json,
                 "\"before\": null,\n    \"after\": null,\n    \"sources\": null,\n    \"sensitivity\": "
                 "null,\n    \"air\": null"));
  CHECK(contains(json, "\"largest_N\": null"));
  CHECK(contains(json, "\"short_blocks\": null,\n    \"lines\": null"));
}

TEST_CASE("text that is not UTF-8 keeps the JSON valid") {
  MadeUpRun run;
  run.facts.warnings = {{1, "comment \xff"}};
  const std::string json = to_json(predicted(run, {}));
  CHECK(contains(json, "comment \xEF\xBF\xBD"));
}

TEST_CASE("the CSV has the documented columns and a row for every waypoint that is not between") {
  std::vector<Waypoint> waypoints = {cut(0, 4, 1, Vector3(1, 0, 0)), cut(0, 4, 1, Vector3(0.1, -0.2, 0.3))};
  waypoints[0].between = true;
  waypoints[0].place = false;
  waypoints[1].s = 0.1;
  waypoints[1].p_MT = Vector3(0.001, 0.002, -0.003);
  waypoints[1].before.tail<3>() = Vector3(0.5, -0.25, 0) * deg;
  const auto lines = lines_of(csv_of(waypoints, {}));
  REQUIRE(lines.size() == 2);
  CHECK(
      lines[0] ==
      "index,line,cutting,s_mm,x_mm,y_mm,z_mm,fx_N,fy_N,fz_N,mx_Nm,my_Nm,mz_Nm,"
      "before_dx_mm,before_dy_mm,before_dz_mm,before_drx_deg,before_dry_deg,before_drz_deg,"
      "geometry_dx_mm,geometry_dy_mm,geometry_dz_mm,geometry_drx_deg,geometry_dry_deg,geometry_drz_deg,"
      "load_dx_mm,load_dy_mm,load_dz_mm,load_drx_deg,load_dry_deg,load_drz_deg,"
      "gravity_dx_mm,gravity_dy_mm,gravity_dz_mm,gravity_drx_deg,gravity_dry_deg,gravity_drz_deg,"
      "preloads_dx_mm,preloads_dy_mm,preloads_dz_mm,preloads_drx_deg,preloads_dry_deg,preloads_drz_deg,"
      "superposition_dx_mm,superposition_dy_mm,superposition_dz_mm,"
      "superposition_drx_deg,superposition_dry_deg,superposition_drz_deg,"
      "after_dx_mm,after_dy_mm,after_dz_mm,after_drx_deg,after_dry_deg,after_drz_deg,"
      "air_dx_mm,air_dy_mm,air_dz_mm,air_drx_deg,air_dry_deg,air_drz_deg,"
      "correction_x_mm,correction_y_mm,correction_z_mm,correction_rx_deg,correction_ry_deg,correction_rz_deg,"
      "status,iterations");
  const std::string zeros = ",0.0000000,0.0000000,0.0000000";
  CHECK(
      lines[1] ==
      "0,4,1,100.000000,1.000000,2.000000,-3.000000,30.000000,-40.000000,0.000000,0.000000,0.000000,2.000000,"
      "0.1000000,-0.2000000,0.3000000,0.5000000,-0.2500000,0.0000000,"
      "0.0250000,-0.0500000,0.0750000" +
          zeros + ",0.0500000,-0.1000000,0.1500000" + zeros + zeros + zeros + zeros + zeros +
          ",0.0750000,-0.1500000,0.2250000" + zeros + ",0.0010000,-0.0020000,0.0030000" + zeros +
          ",-0.0500000,0.1000000,-0.1500000" + zeros + ",-0.1000000,0.2000000,-0.3000000" + zeros +
          ",converged,7");
}

TEST_CASE("rows of a CSV written in portions equal those written at once") {
  std::vector<Waypoint> waypoints = made_up_waypoints();
  const std::string all = csv_of(waypoints, {});
  for (std::size_t cut_at = 0; cut_at <= waypoints.size(); ++cut_at) {
    CAPTURE(cut_at);
    const auto middle = waypoints.begin() + static_cast<std::ptrdiff_t>(cut_at);
    std::size_t next_index = 0;
    std::string text = csv_header() + csv_rows({waypoints.begin(), middle}, {}, next_index);
    text += csv_rows({middle, waypoints.end()}, {}, next_index);
    CHECK(text == all);
    CHECK(next_index == 4);
  }
}

TEST_CASE("columns that were not computed keep their place and are empty") {
  std::vector<Waypoint> waypoints = {cut(0, 4, 1, Vector3(1, 2, 3)), cut(0, 4, 1, Vector3(1, 2, 3))};
  waypoints[1].status = Status::singular;
  const auto lines = lines_of(csv_of(waypoints, {true, false}));
  REQUIRE(lines.size() == 3);
  for (const std::string& line : lines) CHECK(std::count(line.begin(), line.end(), ',') == 68);
  CHECK(contains(lines[1], std::string(19, ',') + "converged,7"));
  CHECK(contains(lines[2], ",2.000000" + std::string(55, ',') + "singular,7"));
}

TEST_CASE("the summary has at most twelve lines: verdict, deviation, force, program, files") {
  MadeUpRun run;
  run.facts.warnings = {{0, "a general warning"}};
  run.facts.attribution = true;
  RunReport report = compensated(run, small_compensation());
  report.sanity = {{"travel", SanityState::ok, "in range"},
                   {"feed force", SanityState::doubtful, "backwards"}};
  const std::string text = summary_text(report, {"r.html"}, false);
  CAPTURE(text);
  CHECK(lines_of(text).size() <= 12);
  CHECK(contains(text, "\ncompensate made_up.ngc on Mill\n"));
  CHECK(contains(text, "  before      0.5000 mm, line 4: assembly "));
  CHECK(contains(text,
                 "  after       0.0050 mm, line 4 (100 times smaller); by the model, tolerance 0.0050 mm\n"));
  CHECK(contains(text, "; 30 % more: 0.0800 mm, 30 % less: 0.0700 mm, none: 0.2500 mm\n"));
  CHECK(contains(text, "3 of 5 moves corrected individually, 1 with one shift for their contour, 1 held, 2"));
  CHECK(contains(text, "  checks 1/2  feed force: backwards\n"));
  CHECK(contains(text, "  written     no corrected program, r.html\n"));
  CHECK(contains(text, "1 warning; -v shows all numbers\n"));
}

TEST_CASE("the details show before and after, and call the remainder a model residual") {
  MadeUpRun run;
  run.facts.warnings = {{0, "a general warning"}, {6, "a warning"}};
  const std::string text = details_text(compensated(run, small_compensation()), false);
  CAPTURE(text);
  CHECK(contains(text, "compensate made_up.ngc\n  on Mill\n  method direct, tolerance 0.0050 mm\n"));
  CHECK(contains(text, "  largest                                 0.5000        0.0050\n"));
  CHECK(contains(text, "model residual: what the model leaves, not the accuracy of the part"));
  CHECK(contains(text, "100 times smaller"));
  CHECK(contains(text,
                 "  load: cutting forces alone              0.0000      0.1500      0.2000      0.2500\n"));
  CHECK(contains(
      text,
      "  3 of 5 moves corrected individually, 2 points added\n  1 with one shift for their contour, 1 "
      "held\n"));
  CHECK(contains(
      text,
      "  With the force 30 % higher (wear, override) the corrected program is off by up to 0.0800 "
      "mm, line\n  4; with it 30 % lower the corrected program is off by up to 0.0700 mm, line 4.\n"));
  CHECK(contains(text, "corrected program is off by up to\n  0.2500 mm, line 4.\n"));
  CHECK(contains(
      text,
      "Not corrected individually: 2 moves, first lines and reasons\n  line 5: exact stop: not split\n"));
  CHECK(contains(text, "2 warnings\n  a general warning\n  line 6: a warning\n"));
  CHECK(contains(text, "Assumptions\n  Program coordinates were taken as machine coordinates"));
}

TEST_CASE("the details of a prediction show no residual") {
  const MadeUpRun run;
  const std::string text = details_text(predicted(run, made_up_waypoints()), false);
  CHECK(contains(text, "  largest                                 0.5000\n"));
  CHECK_FALSE(contains(text, "after"));
  CHECK_FALSE(contains(text, "residual"));
}

TEST_CASE("a machine that is unstable under more force is reported in summary, warning and JSON") {
  const MadeUpRun run;
  const Compensation c = small_compensation();
  RunReport report = compensated(run, c);
  add_made_up_sensitivity(report, c.waypoints, Status::unstable);
  const std::string text = details_text(report, false);
  CAPTURE(text);
  CHECK(
      contains(text, "With the force 30 % higher (wear, override) the machine has no stable equilibrium in"));
  REQUIRE(report.warnings.count == 1);
  CHECK(report.warnings.rows[0].line == 4);
  CHECK(contains(report.warnings.rows[0].what, "unstable; 1 place in all"));
  CHECK(contains(to_json(report), "\"force_plus_30\": null"));
  CHECK_FALSE(contains(to_json(report), "\"force_minus_30\": null"));
  CHECK_FALSE(report.failure);
}

TEST_CASE("a machine with masses has a fifth row of sources") {
  MadeUpRun run;
  run.machine.chains.push_back({"arm", {PointMass{40, Vector3::Zero()}}});
  run.machine.gravity.g = {0, 0, -9.81};
  Compensation c = small_compensation();
  c.waypoints[0].causes->gravity.head<3>() = Vector3(0, 0, -0.02) * mm;
  c.waypoints[0].causes->superposition.head<3>() += Vector3(0, 0, -0.02) * mm;
  const RunReport report = compensated(run, c);
  const std::string text = details_text(report, false);
  CAPTURE(text);
  CHECK(contains(text,
                 "  gravity: weights alone                  0.0000      0.0000      0.0200      0.0200\n"
                 "  superposition: sums at each place "));
  CHECK(contains(text, "  all acting together "));
  CHECK(contains(text, "  where the deviation is largest, line 4:\n"));
  CHECK(contains(to_json(report), "\"gravity\": {\n        \"max_mm\": 0.02,"));
}

TEST_CASE("moves without a force are listed by reason, in the summary and the JSON") {
  const MadeUpRun run;
  RunReport report = compensated(run, small_compensation());
  for (int line = 14; line < 24; ++line) add_unforced(report.forces.without, {line, 7.5 * mm, "a plunge"});
  add_unforced(report.forces.without, {12, 4.2 * mm, "no speed"});
  const std::string text = details_text(report, false), json = to_json(report);
  CHECK(contains(text,
                 "  11 feed moves, 79.200 mm, cut without a force\n"
                 "    10 moves, 75.000 mm, from line 14 on: a plunge\n"
                 "    1 move, 4.200 mm, from line 12 on: no speed\n"));
  CHECK(contains(json, "\"moves\": 11,\n      \"length_mm\": 79.2,"));
  CHECK(contains(json,
                 "\"why\": \"no speed\",\n          \"moves\": 1,\n          \"length_mm\": 4.2,\n          "
                 "\"first_line\": 12\n"));
  CHECK(contains(json, "\"rows\": [\n        {\n          \"line\": 12,\n          \"length_mm\": 4.2,"));
}

TEST_CASE("the summary of a prediction shows the effect of more and less force on the program") {
  const MadeUpRun run;
  const std::string text = details_text(predicted(run, made_up_waypoints()), false);
  CAPTURE(text);
  CHECK(contains(text, "With the force 30 % higher (wear, override) the program is off by up to"));
  CHECK(
      contains(text, "Without the force (dry run, spring pass, broken insert) the program is off by up to"));
}

TEST_CASE("a summary without causes names the option for them") {
  MadeUpRun run;
  const char* const how = "\nFor causes along the path add --report NAME or --json.\n";
  CHECK_FALSE(contains(details_text(compensated(run, small_compensation()), false), how));
  run.facts.attribution = false;
  const std::string text = details_text(compensated(run, small_compensation()), false);
  CAPTURE(text);
  CHECK(contains(text, how));
  CHECK_FALSE(contains(text, "Causes of the deviation"));
  CHECK(contains(text, "30 % higher"));
}

TEST_CASE("the JSON of a failure has the deviation there by its causes, if it was solved") {
  RunReport report;
  report.failure = Failure{ErrorKind::limit, 4, "too far"};
  CHECK_FALSE(contains(to_json(report), "\"at\""));
  report.failure_place = SourcesAtWorst{.line = 4,
                                        .place_mm = {1, 2, 3},
                                        .geometry_mm = {0.5, 0, 0},
                                        .load_mm = {0, 0.25, 0},
                                        .superposition_mm = {0.5, 0.25, 0},
                                        .before_mm = {0.5, 0.25, 0}};
  const auto at = nlohmann::json::parse(to_json(report))["failure"]["at"];
  CHECK(at["geometry_mm"] == nlohmann::json({0.5, 0.0, 0.0}));
  CHECK(at["before_mm"] == nlohmann::json({0.5, 0.25, 0.0}));
  CHECK(at["gravity_mm"].is_null());
}

TEST_CASE("the summary of a failure shows the failure and only known numbers") {
  const MadeUpRun run;
  Compensation none;
  none.failure = Failure{ErrorKind::limit, 4, "the correction is too large"};
  RunReport report = compensated(run, none);
  report.exit_status = 6;
  const std::string text = details_text(report, false);
  CHECK(text.starts_with("FAILED\n"));
  CHECK(contains(text,
                 "Failed (exit status 6)\n  line 4: the correction is too large\n  No corrected program was "
                 "written.\n"));
  CHECK_FALSE(contains(text, "Deviation of the tool tip"));
  CHECK_FALSE(contains(text, "Cutting force"));
}

TEST_CASE("long lists are cut short in the summary, with their number") {
  MadeUpRun run;
  for (int line = 1; line <= 30; ++line) run.program.left_alone.push_back({line, "why"});
  const std::string text = details_text(predicted(run, {}), false);
  CHECK(contains(text, "Not or partly corrected: first lines and reasons\n  line 1: why\n"));
  CHECK(contains(text, "  line 5: why\n  and 25 more\n"));
}

TEST_CASE("the summary is at most 100 characters wide and has no trailing blanks") {
  MadeUpRun run;
  std::string sentence;
  for (int i = 0; i < 60; ++i) sentence += "word" + std::to_string(i) + " ";
  run.facts.warnings = {{123456, sentence}};
  run.machine.work["G54"].datum.touched_at = Vector3(1, 2, 3);
  run.path.frames[0].name = "G54";
  const std::string text = details_text(compensated(run, small_compensation()), false);
  for (const std::string& line : lines_of(text)) {
    CAPTURE(line);
    CHECK(line.size() <= 100);
    CHECK((line.empty() || line.back() != ' '));
  }
}

TEST_CASE("colour adds only escape sequences") {
  const MadeUpRun run;
  const RunReport report = compensated(run, small_compensation());
  const std::string plain = details_text(report, false), coloured = details_text(report, true);
  CHECK_FALSE(contains(plain, "\033"));
  std::string stripped;
  for (std::size_t i = 0; i < coloured.size(); ++i) {
    if (coloured[i] == '\033')
      i = coloured.find('m', i);
    else
      stripped += coloured[i];
  }
  CHECK(stripped == plain);
  CHECK(coloured != plain);
}

TEST_CASE("a run in one line names the program, before and after") {
  const MadeUpRun run;
  CHECK(one_line(compensated(run, small_compensation())) ==
        "made_up.ngc: PARTLY (62 % of the cutting length, 2 feed moves of unknown deviation), 0.5000 mm "
        "before, "
        "0.0050 mm after (model residual)");
  CHECK(one_line(predicted(run, made_up_waypoints())) == "made_up.ngc: OK, 0.5000 mm before");
}
