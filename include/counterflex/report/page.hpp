#pragma once
/// Reports as a page: one HTML file that needs nothing but itself.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/files/file_reader.hpp"
#include "counterflex/report/path_curves.hpp"
#include "counterflex/report/report.hpp"

namespace counterflex {

/// A run as the page has it. Its members but the name are JSON documents; "null": no document.
struct PageRun {
  std::string name;              ///< for people, where there are two
  std::string report;            ///< "counterflex-report 1", as `to_json` writes it
  std::string curves = "null";   ///< as `curves_json` writes them
  std::string loads = "null";    ///< as `loads_json` writes them
  std::string machine = "null";  ///< as `machine_json` writes it
  std::string source = "null";   ///< as `source_json` writes it
  std::string offsets{};         ///< HTML as `offsets_html` writes it; empty: none were requested
};

/// The section of the best constant offsets, in the words of the terminal; empty without offsets.
std::string offsets_html(const RunReport& report);

/// The texts that the page shows beside the path: {"text": the original program, or null if it has more than
/// `longest_program_text` bytes; "output": the absolute path of the corrected program, or null}.
std::string source_json(FileReader& program, const RunReport& report);
inline constexpr std::size_t longest_program_text = 2 << 20;

/// The curves of a path: arrays of numbers as base64 of their bytes, little-endian. Lengths in mm, angles in
/// degrees, forces in N; NaN where a quantity is not known, and no array for one that is known nowhere.
///
///     {"waypoints", "stretches": n, "waypoints_per_stretch",
///      "s_mm": float64[n], "first_line", "last_line", "operation": int32[n], "after_rapid": uint8[n],
///      "place_mm", "place_before_mm", "place_after_mm": float32[3n],
///      "direction": float32[3n], only with one waypoint per stretch: arcs are drawn with it
///      "quantities": {name: {"least", "largest": float32[n]}},    "least" is left out where both are the
///      same "rapids", "force_steps": {"count", "s_mm": [...]}}
std::string curves_json(const PathCurves& curves);

/// The page of one run, or of two side by side, from its beginning to its end: `take` gets it in parts. It
/// loads nothing: what it runs is in it, and its security policy allows nothing else. The data of all runs
/// are one JSON document, "counterflex-page 1", in the element `counterflex-data`:
///
///     {"schema", "runs": [{"name", "report", "curves", "loads", "machine", "source"}], "conclusion": what to
///     take home, in words}
///
/// without the last key where `conclusion` is empty. `sheet` is the HTML of a first printed page, as
/// `proof_sheet` writes it, or empty.
void write_page(const std::string& title, const std::vector<PageRun>& runs,
                const std::function<void(std::string_view)>& take, const std::string& conclusion = "",
                const std::string& sheet = "");

/// The setup sheet of a run with `RunFacts::proof`, as HTML for `write_page`: one page of A4, in words of
/// the shop. It has no date: the same inputs give the same bytes.
std::string proof_sheet(const RunReport& report);

/// "groove.ngc on Orthoglide"; of a verification "groove.comp.ngc for groove.ngc on Orthoglide". "standard
/// input" where a file has no name.
std::string page_title(const RunReport& report);

// The deviation along the path and what it is made of, as a picture for papers and pages.

/// The title of every picture begins so.
inline constexpr std::string_view plot_mark = "Deviation along the path";

/// A plot of `curves`, those of the run of `report`: the components of the deviation before over cutting path
/// length, each with its causes alone (geometry, load and, with masses, gravity), their superposition, and
/// all acting together; below, where there is a corrected program, the size of the model residual and the
/// tolerance. Lengths in the units in which reports show them. A standalone SVG of 800 px by what it takes,
/// on white, without scripts; the same curves give the same bytes. Where the path has more places than the
/// plot has columns each curve is a band from the least to the largest value of a column: no peak is lost.
/// Allocates; does not throw.
std::string to_svg(const PathCurves& curves, const RunReport& report);

}  // namespace counterflex
