#pragma once
/// Writes corrected jobs of Yaskawa robots.
#include <cstdint>
#include <string>
#include <vector>

#include "program/robot/spacing.hpp"
#include "program/robot/writer.hpp"
#include "program/robot/yaskawa/renumber.hpp"

namespace counterflex {

class YaskawaWriter final : public RobotWriter {
 public:
  YaskawaWriter(const Program& window, const WriteOptions& options);

  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) override;

 private:
  std::size_t header_position(const Program& program) const override;
  void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                     std::vector<TextChange>& changes) const override;
  std::map<std::size_t, double> zone_spacings(const Program& program,
                                              const std::vector<MoveEdit>& edits) const override {
    return spacing_at_targets(program, edits, options());
  }
  void limit_zone(const Program& program, const Move& move, double spacing_mm,
                  std::vector<TextChange>& changes) const override;
  /// A new position with the values of `name` after `own` changes; its name in the instruction.
  void add_position(const Program& program, const JbiName& name, bool is_copy, std::vector<TextChange>& own,
                    std::vector<TextChange>& changes) const;

  const JbiJob job_;
  const std::uint32_t first_free_;  ///< the first number that no position has
  /// The positions that the steps of the window need. The base class calls `change_target` once for each
  /// step, in their order.
  mutable std::vector<JbiNewPosition> added_{};
};

}  // namespace counterflex
