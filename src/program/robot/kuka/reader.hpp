#pragma once
/// Reads programs of KUKA robots (.src).
#include "program/robot/kuka/read.hpp"
#include "program/robot/reader.hpp"

namespace counterflex {

class KukaReader final : public RobotReader {
 public:
  KukaReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

 private:
  void read_statement(const RobotLine& line) override { read_krl_statement(krl_, line); }
  void read_comment(const RobotLine& line) override;
  bool next_line(RobotLine& line) const override;

  KrlReading krl_;
};

}  // namespace counterflex
