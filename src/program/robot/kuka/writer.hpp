#pragma once
/// Writes corrected programs of KUKA robots.
#include <functional>
#include <map>

#include "program/robot/kuka/loops.hpp"
#include "program/robot/writer.hpp"

namespace counterflex {

class KukaWriter final : public RobotWriter {
 public:
  KukaWriter(const Program& window, const WriteOptions& options);

  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) override;

 private:
  /// Whether only one move uses the named target of `move`, so that its numbers are changed where it is
  /// declared.
  bool has_declaration_of_its_own(const Program& program, const Move& move) const;

  std::size_t header_position(const Program& program) const override;
  void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                     std::vector<TextChange>& changes) const override;

  std::optional<KrlNumbering> numbering_{};                 ///< of a data list that follows its loop
  std::map<std::string, std::size_t, std::less<>> uses_{};  ///< of variables, if targets have names
};

}  // namespace counterflex
