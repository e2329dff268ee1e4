#pragma once
/// Writes corrected programs of FANUC robots.
#include <set>

#include "program/robot/fanuc/positions.hpp"
#include "program/robot/writer.hpp"

namespace counterflex {

class FanucWriter final : public RobotWriter {
 public:
  FanucWriter(const Program& window, const WriteOptions& options);

  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) override;

 private:
  std::size_t header_position(const Program& program) const override;
  std::string header_text(const std::string& line) const override;
  void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                     std::vector<TextChange>& changes) const override;
  Span copied_part(const Program& program, const Move& move) const override;
  void finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                      std::vector<TextChange>& changes) const override;

  /// The number of a new position with that content.
  long number_of_new(const Move& move, std::string content) const;
  void place_position(const Program& program, long number, std::vector<TextChange>& changes) const;

  /// A motion that has a position as its target, with the content that the position must have for it.
  struct Use {
    const Move* move;
    Span operand;
    std::string content;
  };

  TpFile file_;
  long largest_ = 0;  ///< number of a position in the input
  // Positions that belong to no statement of their own. Statements are changed one by one, and the list of
  // positions behind the last one.
  mutable std::map<long, std::vector<Use>> uses_;  ///< by number of the position
  mutable std::vector<std::string> new_contents_;  ///< in the order of their numbers
  mutable std::map<std::string, long> number_of_content_;
  mutable int line_beyond_ = 0;  ///< of the first move that needs a number above WriteOptions::most_points
};

}  // namespace counterflex
