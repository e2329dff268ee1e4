#pragma once
/// Reads programs of ABB robots (.mod, .prg).
#include "program/robot/rapid/read.hpp"
#include "program/robot/reader.hpp"

namespace counterflex {

class RapidReader final : public RobotReader {
 public:
  RapidReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

 private:
  bool may_end_before(const Move& last, bool anywhere) const override;
  void read_statement(const RobotLine& line) override { read_rapid_line(rapid_, line); }

  RapidReading rapid_;
};

}  // namespace counterflex
