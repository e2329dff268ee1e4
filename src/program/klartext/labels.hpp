#pragma once
/// Labels of Klartext, and the parts of a program that jumps and repetitions may skip or repeat. A place is
/// counted by the blocks that set, call or jump to labels, because a corrected program has the same ones. The
/// n-th of these blocks (from 0) is at place 2 n + 1, blocks before it at 2 n, blocks behind it at 2 n + 2.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "program/klartext/lex.hpp"

namespace counterflex {

/// Places or lines from `first` to `last`, both included.
struct TextStretch {
  int first = 0;
  int last = 0;
};

/// The label name at the beginning of `text` (squeezed): quoted, or digits; "Q" means any label.
std::string label_name(std::string_view text);

/// The place of `block`, where the block before it is at `place`.
int next_place(int place, const KlartextBlock& block);

/// Whether one of `stretches`, which are sorted and disjoint, contains a place or line.
bool contains(const std::vector<TextStretch>& stretches, int at);

/// Properties of a Klartext program that depend on its whole text.
struct KlartextOutline {
  /// Blocks that may run never or several times: bodies of called subprograms, repeated parts, and blocks
  /// skipped by a jump; sorted and disjoint.
  std::vector<TextStretch> uncertain;
  /// Lines of the CC whose pole is used by blocks that are not followed, so that no arc about it may move it;
  /// sorted.
  std::vector<int> poles;
  /// Lines from the first call of a defined cycle to the last one, if there are several; sorted and disjoint.
  std::vector<TextStretch> series;
};

/// Scans a text once, in portions of whole blocks.
class KlartextScan {
 public:
  void add(std::string_view blocks);
  KlartextOutline finish() const;

 private:
  /// The uses of a label name, with their places.
  struct Label {
    std::vector<int> set{};
    std::vector<int> jumped_to{};  ///< by jumps and repetitions
    bool called = false;           ///< as a subprogram
  };
  /// Of the CC.
  struct PoleUse {
    int line;
    int place;  ///< of a polar block, which is followed outside of `uncertain` stretches
    bool plain;

    bool operator==(const PoleUse&) const = default;
  };

  void take_label(std::string_view text);
  void take_pole(std::string_view text);
  void take_cycle(std::string_view text);
  void add_body(int first, std::vector<TextStretch>& stretches) const;
  std::vector<TextStretch> uncertain() const;

  KlartextBlock block_;
  int place_ = 0;
  int pole_ = 0;  ///< line of the last CC
  std::map<std::string, Label> labels_;
  std::vector<PoleUse> pole_uses_;
  std::vector<TextStretch> series_;
  bool cycle_is_called_ = false;  ///< since its definition: the last of `series_` is that of the cycle
};

}  // namespace counterflex
