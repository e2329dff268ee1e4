#pragma once
/// The comments (FORCE FX=215 FY=-10 FZ=-25 MX=1 MY=21.5) and (FORCE OFF).
#include <optional>

#include "counterflex/geometry/types.hpp"
#include "program/text/lex.hpp"

namespace counterflex {

struct ForceComment {
  std::optional<Vector6> F;  ///< N, N m; zero for components that are not given; empty: OFF
};

/// The force of `comment` of `block`; empty if its first word is not FORCE. Throws `InputError`
/// (ErrorKind::machine_or_force) if it is malformed.
std::optional<ForceComment> read_force_comment(std::string_view text, const std::string& file,
                                               const Block& block, Span comment);

}  // namespace counterflex
