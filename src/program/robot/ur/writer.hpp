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
  std::string smaller_zone(const Program& program, const TargetZone& zone, double spacing_mm) const override;
  std::map<std::size_t, double> zone_spacings(const Program& program,
                                              const std::vector<MoveEdit>& edits) const override;
  void finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                      std::vector<TextChange>& changes) const override;

  /// Targets that have names: changed where they are declared if all moves to them want the same numbers, and
  /// no other statement reads them; else the pose with its new numbers takes the place of the name.
  void change_named_targets(const Program& program, const std::vector<MoveEdit>& edits,
                            std::vector<TextChange>& changes) const;

  UrNames names_;
};

}  // namespace counterflex
