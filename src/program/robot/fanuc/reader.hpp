#pragma once
/// Reads programs of FANUC robots (.ls).
#include "program/robot/fanuc/read.hpp"
#include "program/robot/reader.hpp"

namespace counterflex {

class FanucReader final : public RobotReader {
 public:
  FanucReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

 private:
  bool next_line(RobotLine& line) const override;
  void read_statement(const RobotLine& line) override { read_tp_line(tp_, line); }
  void read_comment(const RobotLine& line) override;

  TpReading tp_;
};

/// Whether a remark at the begin of /MN is the header of a corrected program.
bool is_corrected_tp_program(std::string_view text);

}  // namespace counterflex
