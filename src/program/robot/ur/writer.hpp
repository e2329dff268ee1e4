#pragma once
/// Writes corrected programs of Universal Robots.
#include <map>

#include "program/robot/ur/names.hpp"
#include "program/robot/writer.hpp"

namespace counterflex {

class UrWriter final : public RobotWriter {
 public:
  UrWriter(const Program& window, const WriteOptions& options);

 private:
  std::size_t header_position(const Program& program) const override;
  void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                     std::vector<TextChange>& changes) const override;
  void finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                      std::vector<TextChange>& changes) const override;

  /// Targets that have names: changed where they are declared if all moves to them want the same numbers, and
  /// no other statement reads them; else the pose with its new numbers takes the place of the name.
  void change_named_targets(const Program& program, const std::vector<MoveEdit>& edits,
                            std::vector<TextChange>& changes) const;
  void shrink_zones(const Program& program, const std::vector<MoveEdit>& edits,
                    std::vector<TextChange>& changes) const;

  /// Blend radius of a call, and the change that makes it at most `limit_mm`; nothing to do without a change.
  double zone_mm(std::string_view text, const UrCall& call) const;
  void limit_zone(std::string_view text, const UrCall& call, double limit_mm,
                  std::vector<TextChange>& changes) const;

  UrNames names_;
};

}  // namespace counterflex
