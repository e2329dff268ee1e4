#pragma once
/// Writes corrected robot programs: numbers of targets in their places, and copies of a move's own statement
/// for inserted points. A language derives from it.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "program/program_writer.hpp"
#include "program/robot/line.hpp"
#include "program/write/step.hpp"

namespace counterflex {

/// Characters that replace a span of the program.
struct TextChange {
  Span span;
  std::string text;
};

/// The numbers of a target to write; empty for a number that stays.
struct TargetNumbers {
  std::array<std::optional<WordNumber>, 3> through;  ///< X, Y, Z of the auxiliary point of an arc
  std::array<std::optional<WordNumber>, 3> position;
  std::array<std::optional<WordNumber>, 4> orientation;
  OrientationNumbers turned{};  ///< all numbers of the written orientation, also those that stay
  bool is_copy = false;         ///< for a copy of the statement, else for the statement itself
  bool becomes_line = false;    ///< the statement of an arc becomes that of a line, without auxiliary point
};

class RobotWriter : public ProgramWriter {
 public:
  RobotWriter(const Program& window, const WriteOptions& options, std::string_view comment_mark);

  Rewritten write(const Program& window, const std::vector<MoveEdit>& edits) override;

 protected:
  /// Position of the header: at the begin of a line, or at the end of the text.
  virtual std::size_t header_position(const Program& program) const = 0;

  /// A line of the header with its line end. The default is a comment.
  virtual std::string header_text(const std::string& line) const;

  /// Appends the changes that give the target of `move` these numbers. The default changes the words in their
  /// places; the target must have all of them.
  virtual void change_target(const Program& program, const Move& move, const TargetNumbers& numbers,
                             std::vector<TextChange>& changes) const;

  /// The words of a zone that is at most half of `spacing_mm`. Of a language whose moves have zones.
  virtual std::string smaller_zone(const Program& program, const TargetZone& zone, double spacing_mm) const;

  /// The moves with zones to limit, and the distances from their targets to the nearest point. By default
  /// those beside inserted points.
  virtual std::map<std::size_t, double> zone_spacings(const Program& program,
                                                      const std::vector<MoveEdit>& edits) const;

  /// Adds or replaces changes that depend on several edits, when those of all edits are there: of a target
  /// that several moves use. The default does nothing.
  virtual void finish_changes(const Program& program, const std::vector<MoveEdit>& edits,
                              std::vector<TextChange>& changes) const;

  /// The part of the line of `move` that a copy of its statement repeats, from the begin of the line. By
  /// default all but the comment and the blanks before it.
  virtual Span copied_part(const Program& program, const Move& move) const;

  const std::string& line_end() const { return line_end_; }
  const WriteOptions& options() const { return options_; }

 private:
  struct Output;
  void add_header(Output& output) const;
  void limit_zone(const Program& program, const Move& move, double spacing_mm,
                  std::vector<TextChange>& changes) const;
  void write_move(const MoveEdit& edit, Output& output);
  void insert_point(const Move& move, const Via& via, int motion, double spacing_mm, std::string& text,
                    Output& output);

  WriteOptions options_;
  std::string_view comment_mark_;
  std::string line_end_;
  TextPosition position_{};  ///< in the written text
  PointCount points_{};
  bool begun_ = false, guarded_ = false;
};

/// The bytes `within` of `text` with `changes`, which are inside of them and are sorted here.
std::string with_changes(std::string_view text, Span within, std::vector<TextChange>& changes);

/// `value` with `decimals` digits in the style of the number at `number` of `text`.
std::string number_text(std::string_view text, Span number, double value, int decimals);

}  // namespace counterflex
