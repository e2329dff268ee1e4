#pragma once
/// The comments (FORCE FX=215 FY=-10 FZ=-25 MX=1 MY=21.5) and (FORCE OFF).
#include <optional>

#include "counterflex/geometry/types.hpp"
#include "program/lex.hpp"

namespace counterflex {

/// The wrench (N, N m) that `comment` of `block` states, zero for OFF and for components that it does not
/// name; nothing where its first word is not FORCE. Throws `InputError` (Exit::machine_or_force) where it is
/// malformed.
std::optional<Vector6> read_force_comment(std::string_view text, const std::string& file, const Block& block,
                                          Span comment);

}  // namespace counterflex
