#pragma once
/// Limits of controls on the size of a robot program.
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "counterflex/program/rewrite.hpp"

namespace counterflex {

/// What a control limits.
struct SizeLimit {
  std::string_view dialect;
  std::string_view control;
  std::string_view counted;  ///< "positions", "targets"
  std::size_t most = 0;
};

/// The limit of the controls that read `dialect`; null for a control without a known limit.
const SizeLimit* size_limit(std::string_view dialect);

/// Throws `InputError` (ErrorKind::program_text) if the written program of `file` has more points than
/// `most`, the number that the user gave, or without it than the control allows. An original that has more
/// points than the control allows shows that this one allows more.
void refuse_too_many_points(const std::string& file, std::string_view dialect, const PointCount& points,
                            std::optional<std::size_t> most);

}  // namespace counterflex
