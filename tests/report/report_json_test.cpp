#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/report/formats.hpp"
#include "made_up_run.hpp"
#include "support/text.hpp"

using namespace counterflex;
using namespace counterflex::test;

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
      "unknown_length": 0,
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
    ],
    "machine_positions_count": 0,
    "machine_positions": []
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
    "zones": null,
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
  CHECK(contains(json,
                 "\"failure\": {\n    \"exit\": 6,\n    \"kind\": \"limit\",\n    \"line\": 4,\n    "
                 "\"what\": \"too far\"\n  }"));
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
