#include "counterflex/program/size_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "counterflex/files/input_error.hpp"
#include "counterflex/program/parts.hpp"
#include "program/dialect.hpp"

namespace counterflex {
namespace {

// Limits that integrators of these controls give. They differ between versions of a control, and no manual
// was at hand to confirm them: --max-points replaces them. No limit is known of KRL (arrays, files), RAPID
// and INFORM (positions of a job).
constexpr std::array limits{SizeLimit{tp_name, "FANUC TP", "positions", 999},
                            SizeLimit{ur_name, "URScript", "targets", 2500}};

}  // namespace

const SizeLimit* size_limit(std::string_view dialect) {
  const auto found = std::ranges::find(limits, dialect, &SizeLimit::dialect);
  return found != limits.end() ? &*found : nullptr;
}

void refuse_too_many_points(const std::string& file, std::string_view dialect, const PointCount& points,
                            std::optional<std::size_t> most) {
  const SizeLimit* limit = size_limit(dialect);
  const std::string_view counted = limit != nullptr ? limit->counted : "targets";
  const bool divided = can_be_divided(dialect);
  if (most && points.after > *most)
    throw InputError(
        ErrorKind::program_text, {file, points.first_line_beyond, 1},
        fmt::format("the corrected program has {} {}, the first above --max-points {} here; {}post "
                    "several programs, or allow a larger --tolerance-mm",
                    points.after, counted, *most,
                    divided ? "" : fmt::format("{}: ", why_not_divided(dialect))));
  if (most || limit == nullptr || points.after <= limit->most || points.before > limit->most) return;
  throw InputError(
      ErrorKind::program_text, {file, points.first_line_beyond, 1},
      fmt::format("the corrected program has {0} {1}, but a {2} program has at most {3}, reached "
                  "here; allow a larger --tolerance-mm, {4}or give --max-points the limit of a "
                  "control that allows more",
                  points.after, counted, limit->control, limit->most,
                  divided ? fmt::format("divide it with --max-points {}, ", limit->most) : ""));
}

}  // namespace counterflex
