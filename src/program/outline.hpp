#pragma once
/// Properties of a program that depend on its whole text.
#include <cstddef>
#include <string_view>
#include <vector>

#include "program/dialect.hpp"
#include "program/klartext/labels.hpp"
#include "program/robot/kuka/loops.hpp"
#include "program/robot/kuka/routines.hpp"
#include "program/robot/rapid/module.hpp"

namespace counterflex {

struct Outline {
  bool jumps = false;  ///< it has GOTO
  /// For each line that begins with an O-number: whether M99 ends its program.
  std::vector<bool> subprograms;
  KlartextOutline klartext{};
  /// A robot program gives targets or other data names: moves depend on lines far from them.
  bool named_targets = false;
  bool data_lists = false;  ///< data lists follow a KUKA program
  KrlArrays arrays{};       ///< of these data lists
  KrlFacts krl{};           ///< of the routines of a KUKA program
  /// Of an ABB module that is not read as a whole: its routines, and those that do not move the robot.
  RapidNames routines{}, still_routines{};
  bool list_follows_loop = false;  ///< the data list is behind the loop that uses it
  bool tool_axes = false;          ///< an APT program gives tool axes: GOTO/ with six numbers
  /// Programs and subprograms that a text in G-code defines, of those that are stated as harmless.
  CallNames own_programs{};
};

/// Scans a text once, in portions of whole blocks. Finds nothing in dialects of G-code without numbered
/// programs.
class OutlineScan {
 public:
  /// `names`: `harmless_calls` of ReadOptions.
  OutlineScan(const Dialect& dialect, const CallNames& names)
      : dialect_(dialect), harmless_(names), rapid_(names), krl_(names) {}
  /// Whether programs in the dialect can have such properties.
  bool may_find() const;
  void add(std::string_view blocks);
  Outline finish();

 private:
  void add_numbered(std::string_view lines);
  void add_krl(std::string_view lines);

  void add_own_programs(std::string_view lines);
  bool names_programs() const;

  const Dialect& dialect_;
  const CallNames& harmless_;
  bool begun_ = false;
  Outline outline_;
  KlartextScan klartext_;
  RapidScan rapid_;
  KrlScan krl_;
  std::size_t open_ = 0;  ///< number of programs at the end of the list that have not ended yet
};

Outline outline_of(std::string_view text, const Dialect& dialect, const CallNames& harmless = {});

/// Whether a line begins with an O-number.
bool is_numbered(std::string_view line);

}  // namespace counterflex
