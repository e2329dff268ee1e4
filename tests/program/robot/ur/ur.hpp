#pragma once
/// Helpers of the tests of URScript.
#include "program/robot/edits.hpp"

namespace counterflex::test {

inline Program read_ur(const std::string& text) {
  return read_program(text, "job.script", {});
}

/// The statements in a function, which begin in line 2.
inline std::string ur_program_of(const std::string& statements) {
  return "def job():\n" + statements + "end\n";
}

inline Program read_ur_statements(const std::string& statements) {
  return read_ur(ur_program_of(statements));
}

inline const std::string ur_milling =
    "# made by hand\n"
    "def Program():\n"
    "  # POCKET\n"
    "  tool = p[0, 0, 0.1, 0, 0, 1.5708]\n"
    "  slow = 0.05\n"
    "  zone = 0.002\n"
    "  set_tcp(tool)\n"
    "  movej([2.2208, -2.4093, 2.5006, 3.0503, 0.9208, -3.1416], a=12.5, v=0.3, r=zone)\n"
    "  movej(p[0.7, 0.25, 0.6, -1.2092, -1.2092, -1.2092], a=1, v=0.3)\n"
    "  movel(p[0.7, 0.25, .5, -1.2092, -1.2092, -1.2092], a=2.5, v=slow, r=zone) # down\n"
    "  movep(p[+0.8, 0.25, 5e-1, 0.0, 3.1415927, 0], 1.2, 0.1, 0.001)\n"
    "end\n";

}  // namespace counterflex::test
