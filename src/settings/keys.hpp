#pragma once
/// The keys of project and jobs files, and the kinds of their values.
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex::setting_file {

enum class Kind {
  text,
  number,
  whole,    ///< a whole number
  truth,    ///< true or false
  path,     ///< of one file
  paths,    ///< of one or several
  forces,   ///< texts and arrays of numbers
  output,   ///< the name of an output, or a pattern
  report,   ///< the same, or true or false
  plot,     ///< the same; it ends in .svg
  offsets,  ///< tables of [work]
  lengths,  ///< tables of [tools]
};

struct Key {
  std::string_view option;  ///< "tolerance-mm"
  Kind kind;
};

inline constexpr std::array keys{Key{"machine", Kind::path},
                                 Key{"forces", Kind::paths},
                                 Key{"force", Kind::forces},
                                 Key{"load-scale", Kind::number},
                                 Key{"air-above", Kind::number},
                                 Key{"blend-mm", Kind::number},
                                 Key{"dialect", Kind::text},
                                 Key{"units", Kind::text},
                                 Key{"integer-words", Kind::text},
                                 Key{"arc-centres", Kind::text},
                                 Key{"evaluate", Kind::truth},
                                 Key{"expand-subprograms", Kind::truth},
                                 Key{"data", Kind::paths},
                                 Key{"tool-table", Kind::path},
                                 Key{"temperature-C", Kind::number},
                                 Key{"uncertainty", Kind::path},
                                 Key{"samples", Kind::whole},
                                 Key{"method", Kind::text},
                                 Key{"tolerance-mm", Kind::number},
                                 Key{"max-correction-mm", Kind::number},
                                 Key{"tolerance-tilt-deg", Kind::number},
                                 Key{"tolerance-spin-deg", Kind::number},
                                 Key{"free", Kind::text},
                                 Key{"only-significant", Kind::truth},
                                 Key{"accept-partial", Kind::truth},
                                 Key{"decimals", Kind::whole},
                                 Key{"number-pieces", Kind::truth},
                                 Key{"max-points", Kind::whole},
                                 Key{"guard", Kind::truth},
                                 Key{"proof", Kind::truth},
                                 Key{"threads", Kind::whole},
                                 Key{"min-block-ms", Kind::number},
                                 Key{"output", Kind::output},
                                 Key{"report", Kind::report},
                                 Key{"plot", Kind::plot},
                                 Key{"force-overwrite", Kind::truth},
                                 Key{"work", Kind::offsets},
                                 Key{"tool-length", Kind::lengths}};

/// Names for `report = true` and `plot = true`: beside the output.
inline constexpr std::string_view report_beside_output = "{output}", plot_beside_output = "{output}.svg";

/// "tolerance-mm" gives "tolerance_mm"; "tool-length" gives "tools", the table with lengths.
std::string key_of_option(std::string_view option);

/// "tolerance-mm" gives "COUNTERFLEX_TOLERANCE_MM".
std::string variable_of(std::string_view option);

}  // namespace counterflex::setting_file
