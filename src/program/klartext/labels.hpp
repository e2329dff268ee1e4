#pragma once
/// Labels of Klartext, and the stretches of a program that jumps and repetitions put in doubt. Places are counted
/// by the blocks that set, call or jump to labels, which a corrected program has, too: the n-th of them (from 0) is
/// at 2 n + 1, the blocks before it at 2 n, those behind it at 2 n + 2.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/klartext/lex.hpp"

namespace counterflex {

/// Places from `first` to `last`, both included.
struct PlaceStretch {
  int first = 0;
  int last = 0;
};

/// The name that `text` (squeezed) begins with: quoted, or digits; "Q" stands for any.
std::string label_name(std::string_view text);

/// The place of `block`, of the one behind `place`.
int next_place(int place, const KlartextBlock& block);

/// Whether one of `stretches`, in order and apart, holds `place`.
bool holds(const std::vector<PlaceStretch>& stretches, int place);

/// What a Klartext program shows only when looked at as a whole.
struct KlartextOutline {
  std::vector<PlaceStretch> doubtful;  ///< blocks that may run often or not at all: bodies of subprograms that are called,
                                  ///< parts that are repeated, and what a jump passes over; in order and apart
  std::vector<int> poles;         ///< lines of the CC whose pole blocks use that are not followed, so that it cannot
                                  ///< be moved with the arcs about it; in order
};

/// Looks through a text once, in portions of whole blocks.
class KlartextScan {
 public:
  void add(std::string_view blocks);
  KlartextOutline finish() const;

 private:
  /// What of one name stands at which places.
  struct Label {
    std::vector<int> set{};
    std::vector<int> jumped_to{};  ///< by jumps and repetitions
    bool called = false;           ///< as a subprogram
  };
  struct PoleUse {
    int line;   ///< of the CC
    int place;  ///< of a polar block, which is followed outside of doubts
    bool plain;

    bool operator==(const PoleUse&) const = default;
  };

  void take_label(std::string_view text);
  void take_pole(std::string_view text);
  void add_body(int first, std::vector<PlaceStretch>& stretches) const;
  std::vector<PlaceStretch> doubtful() const;

  KlartextBlock block_;
  int place_ = 0;
  int pole_ = 0;  ///< line of the last CC
  std::map<std::string, Label> labels_;
  std::vector<PoleUse> pole_uses_;
};

}  // namespace counterflex
