#pragma once
/// Helpers of the tests of FANUC TP.
#include <fmt/format.h>

#include "program/robot/edits.hpp"

namespace counterflex::test {

inline Program read_tp(const std::string& text) {
  return read_program(text, "job.ls", {});
}

/// A position with these numbers of X Y Z W P R.
inline std::string tp_position(int number, const std::array<double, 6>& n, const std::string& more = "",
                               const std::string& selection = "UF : 1, UT : 2") {
  return fmt::format(
      "P[{}]{{\n   GP1:\n\t{},\t\tCONFIG : 'N U T, 0, 0, 0',\n"
      "\tX =  {:8.3f}  mm,\tY =  {:8.3f}  mm,\tZ =  {:8.3f}  mm,\n"
      "\tW =  {:8.3f} deg,\tP =  {:8.3f} deg,\tR =  {:8.3f} deg{}\n}};\n",
      number, selection, n[0], n[1], n[2], n[3], n[4], n[5], more);
}

/// A program of statements without numbers, which begin in line 6, and of positions.
inline std::string tp_program(const std::string& statements, const std::string& positions) {
  std::string text = "/PROG  JOB\n/ATTR\nCOMMENT\t\t= \"by hand\";\n";
  std::string lines;
  int number = 0;
  for (std::size_t at = 0; at < statements.size();) {
    const std::size_t end = statements.find('\n', at);
    const std::string line = statements.substr(at, end - at);
    lines += line.starts_with(":") ? "    " + line + "\n" : fmt::format("{:4}:{}\n", ++number, line);
    at = end + 1;
  }
  return text + fmt::format("LINE_COUNT\t= {};\n/MN\n", number) + lines + "/POS\n" + positions + "/END\n";
}

/// P[1] to P[4] around a pocket, all in frame 1 with tool 2.
inline std::string tp_square() {
  return tp_position(1, {0, 0, 50, 180, 0, 0}) + tp_position(2, {0, 0, 0, 180, 0, 0}) +
         tp_position(3, {100, 0, 0, 180, 0, 10}) + tp_position(4, {100, 80, 0, 180, 0, 10});
}

inline Program read_tp_statements(const std::string& statements, const std::string& positions = tp_square()) {
  return read_tp(tp_program(statements, positions));
}

/// The refusal of a program; "none" if it is read.
inline std::string tp_refusal(const std::string& statements, const std::string& positions = tp_square()) {
  return diagnostic_of([&] { read_tp_statements(statements, positions); });
}

}  // namespace counterflex::test
