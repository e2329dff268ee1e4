#pragma once
/// Reads jobs of Yaskawa robots (.jbi).
#include "program/robot/reader.hpp"
#include "program/robot/yaskawa/read.hpp"

namespace counterflex {

class YaskawaReader final : public RobotReader {
 public:
  YaskawaReader(const std::string& file, const ReadOptions& options, const Dialect& dialect, Outline outline);

  bool read_block() override;

 private:
  void read_statement(const RobotLine& line) override { read_jbi_statement(jbi_, line); }
  void read_comment(const RobotLine& line) override;

  JbiReading jbi_;
};

/// Whether the instructions of a job begin with the header of a corrected program.
bool is_corrected_job(std::string_view text);

}  // namespace counterflex
