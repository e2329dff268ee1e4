#pragma once
/// Jobs of Yaskawa robots in tests.
#include <string>

#include "program/reading.hpp"
#include "program/robot/edits.hpp"

namespace counterflex::test {

/// The positions of most tests: C00000 is in pulses, the others are in USER 1 with tool 2.
inline const std::string jbi_positions_text =
    "///USER 1\n///TOOL 2\n///POSTYPE PULSE\n///PULSE\nC00000=390876,202089,35618,0,-117424,182917\n"
    "///POSTYPE USER\n///RECTAN\n///RCONF 1,0,0,0,0,0\n"
    "C00001=0.000,0.000,50.000,180.0000,0.0000,0.0000\n"
    "C00002=0.000,0.000,0.000,180.0000,0.0000,0.0000\n"
    "C00003=100.000,0.000,0.000,180.0000,0.0000,10.0000\n";

/// A job with these positions and instructions. `count`: of C.
inline std::string job_of(const std::string& positions, const std::string& instructions, int count = 4) {
  return "/JOB\n//NAME PART\n//POS\n///NPOS " + std::to_string(count) + ",0,0,0,0,0\n" + positions +
         "//INST\n///DATE 2020/11/19 13:27\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n" + instructions + "END\n";
}

inline Program read_job(const std::string& text) {
  return read_program(text, "part.jbi", {});
}

/// The refusal of a job; "none" if it is read.
inline std::string refusal_of_job(const std::string& text) {
  return diagnostic_of([&] { read_job(text); });
}

/// The job of `jbi_positions_text` and these instructions.
inline Program read_steps(const std::string& instructions) {
  return read_job(job_of(jbi_positions_text, instructions));
}

/// The lines of a written job from the first position on, and from NOP on.
inline std::string positions_in(const std::string& text) {
  const std::size_t begin = text.find("C0000");
  return text.substr(begin, text.find("//INST") - begin);
}
inline std::string instructions_in(const std::string& text) {
  const std::size_t begin = text.find("NOP\n") + 4;
  return text.substr(begin, text.rfind("END") - begin);
}

}  // namespace counterflex::test
