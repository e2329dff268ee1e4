#pragma once
/// Writes corrected APT and cutter location files.
#include "program/robot/writer.hpp"

namespace counterflex {

class AptWriter final : public RobotWriter {
 public:
  AptWriter(const Program& window, const WriteOptions& options);

 private:
  std::size_t header_position(const Program& program) const override;
  void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                     std::vector<TextChange>& changes) const override;
  Span copied_part(const Program& program, const Move& move) const override;
};

}  // namespace counterflex
