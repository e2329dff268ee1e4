#pragma once
/// Reads programs of Universal Robots (.script).
#include "program/robot/reader.hpp"
#include "program/robot/ur/read.hpp"

namespace counterflex {

class UrReader final : public RobotReader {
 public:
  UrReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

 private:
  void read_statement(const RobotLine& line) override;

  UrReading ur_;
  bool names_are_known_ = false;
};

}  // namespace counterflex
