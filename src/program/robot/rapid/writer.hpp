#pragma once
/// Writes corrected programs of ABB robots.
#include "program/robot/rapid/data.hpp"
#include "program/robot/writer.hpp"

namespace counterflex {

class RapidWriter final : public RobotWriter {
 public:
  RapidWriter(const Program& window, const WriteOptions& options);

 private:
  std::size_t header_position(const Program& program) const override;
  void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                     std::vector<TextChange>& changes) const override;
  std::string smaller_zone(const Program& program, const TargetZone& zone, double spacing_mm) const override;
  void finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                      std::vector<TextChange>& changes) const override;

  RapidModule module_{};  ///< of a program that is one window
};

}  // namespace counterflex
