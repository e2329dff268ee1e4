#pragma once
/// Finds the rule that acts at each place of a segment: the most specific one that covers it.
#include <optional>
#include <unordered_map>
#include <vector>

#include "counterflex/forces/forces.hpp"
#include "forces/path/profile/alignment.hpp"
#include "forces/path/profile/profile_cover.hpp"
#include "forces/path/rules/rule_index.hpp"

namespace counterflex {

/// A part of a segment between two fractions of its length. Without rule and comment it has no force.
struct ForceStretch {
  double from = 0, to = 1;
  const ForceRule* rule = nullptr;
  bool comment = false;  ///< the program's FORCE comment acts
};

/// The coverage of one window of a program. Keeps references to the arguments.
class Coverage {
 public:
  /// `block_number` is N of the previous moves, then of these. Throws `InputError` if the program lacks what
  /// the key of a profile needs.
  Coverage(const ForceSource& source, const Program& window, const Toolpath& path,
           std::optional<long>& block_number);

  /// The stretches of segment i, in order and without gaps; valid until the next call. Throws `InputError` if
  /// two rules of equal rank cover it.
  const std::vector<ForceStretch>& stretches(std::size_t i);

  /// The rule or comment that acts in the hole of a move: a profile does not. Throws as `stretches`.
  ForceStretch hole(std::size_t move);
  bool has_profiles() const { return !profiles_.empty(); }

  /// The keys of a profile over segment i.
  const KeySpan& keys(const ForceRule& profile, std::size_t i) const;

 private:
  /// The part of a segment that a rule for places covers, in fractions: [from, to], extended to [least, most]
  /// for rounded keys.
  struct Claim {
    double from = 0, to = 1, least = 0, most = 1;
    double rounding = 0;
    const ForceRule* rule = nullptr;  ///< nullptr: a comment
    std::size_t row = 0;
  };
  const ForceRule* by_kind(const Move& move);
  const std::string& operation_of(const Move& move);
  void claim(std::size_t move);
  void claim_rows(const ForceRule& rule, std::size_t i);
  void settle(int line);
  [[noreturn]] void refuse(const Claim& a, const Claim& b, int line) const;
  std::optional<long> number(std::size_t i) const;

  const ForceSource& source_;
  const Program& window_;
  const Toolpath& path_;
  RuleIndex index_;
  std::vector<const ForceRule*> profiles_;
  std::vector<std::vector<KeySpan>> keys_;    ///< of each profile
  std::vector<std::optional<long>> numbers_;  ///< block numbers of the moves, if a rule needs them
  std::unordered_map<std::uint64_t, const ForceRule*> kinds_;  ///< the rule by tool and operation
  std::optional<std::uint64_t> last_kind_;
  const ForceRule* last_acts_ = nullptr;
  std::optional<std::uint32_t> last_operation_;
  std::string folded_operation_;  ///< its text
  std::vector<KeyCover> covers_;
  std::vector<Claim> claims_;
  std::vector<const ForceRule*> found_;
  std::vector<ForceStretch> stretches_;
};

/// Whether the whole move, with the hole of its cycle, is above --air-above of the source.
bool in_air(const ForceSource& source, const Move& move);

}  // namespace counterflex
