#pragma once
/// Helpers of the tests of KUKA KRL.
#include "program/robot/edits.hpp"

namespace counterflex::test {

inline Program read_krl(const std::string& text) {
  return read_program(text, "job.src", {});
}

/// The statements in a routine, which begin in line 2.
inline Program read_statements(const std::string& statements) {
  return read_krl("DEF job()\n" + statements + "END\n");
}

inline const std::string milling =
    "&ACCESS RVO1\n"
    "&COMMENT made by hand\n"
    "DEF job( )\n"
    ";-- POCKET\n"
    "$BASE={X 100.0,Y 0.0,Z 0.0,A 90.0,B 0.0,C 0.0}\n"
    "$TOOL=TOOL_DATA[5]\n"
    "PTP {A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 90.0,A6 0.0,E1 850.0}\n"
    "PTP {X 10.0,Y 20.0,Z 30.0,A 40.0,B -0.000,C 180.0,S 2,T 10,E1 850.0}\n"
    "$VEL.CP = 0.05\n"
    "LIN {X 10.0,Y 20.0,Z -1.5,A 40.0,B -0.000,C 180.0,E1 850.0} C_DIS ;down\n"
    "lin {x 60,y 20,z -1.5,a 50,b 0,c 180,e1 850} c_dis\n"
    "END\n";

}  // namespace counterflex::test
