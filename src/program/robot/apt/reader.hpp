#pragma once
/// Reads APT and cutter location files.
#include "program/robot/apt/read.hpp"
#include "program/robot/reader.hpp"

namespace counterflex {

class AptReader final : public RobotReader {
 public:
  AptReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

 private:
  bool next_line(RobotLine& line) const override { return next_apt_line(program().text, line); }
  void read_statement(const RobotLine& line) override { read_apt_statement(apt_, line); }

  AptReading apt_;
};

}  // namespace counterflex
