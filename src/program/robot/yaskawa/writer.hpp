#pragma once
/// Writes corrected jobs of Yaskawa robots.
#include <cstdint>
#include <string>
#include <vector>

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
  std::string smaller_zone(const Program& program, const TargetZone& zone, double spacing_mm) const override;
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
