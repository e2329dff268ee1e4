#include "program/klartext/codes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "program/gcode/remarks.hpp"

namespace counterflex {
namespace {

void read_code(int code, const KlartextBlock& block, KlartextReading& r, KlartextCodes& codes) {
  constexpr std::array after{0, 1, 2, 5, 6, 9, 30, 60, 89, 99, 140};
  constexpr std::array without_motion{0,   1,   2,   3,   4,   5,   6,   8,   9,   13,  14,  30,  60,  89,
                                      90,  91,  92,  94,  97,  98,  99,  101, 102, 103, 107, 108, 109, 110,
                                      111, 116, 117, 118, 120, 126, 127, 136, 137, 140, 141, 143, 148, 149};
  codes.machine_position = codes.machine_position || code == 91 || code == 92;
  codes.cycle_call = codes.cycle_call || code == 89 || code == 99;
  codes.calls_each = codes.calls_each || code == 89;
  codes.retracts = codes.retracts || code == 140;
  codes.ends = codes.ends || code == 2 || code == 30;
  codes.acts_after = codes.acts_after || std::find(after.begin(), after.end(), code) != after.end();
  if (code == 136 || code == 137) r.state.feed_per_turn = code == 136, r.state.feed = {};
  if (code == 103) r.state.plunges_slower = find_word(r.words, "F") != nullptr;
  if (code == 3 || code == 4 || code == 13 || code == 14) r.state.spindle_off = false;
  codes.stops_spindle = codes.stops_spindle || code == 5 || code == 19;
  if (code == 128 || code == 114 || code == 144)
    r.state.displacements[128] = fmt::format("M{} moves the linear axes with the rotary axes", code);
  if (code == 129 || code == 115 || code == 145) r.state.displacements.erase(128);
  if (code == 143) delete_basic_rotation(block, r);
  if (code == 124)
    add_remark(r.program, line_of_file(r.program.expansion, block.line),
               "M124: the control skips points that are closer than its limit");
  else if (std::find(without_motion.begin(), without_motion.end(), code) == without_motion.end())
    add_remark(r.program, line_of_file(r.program.expansion, block.line),
               fmt::format("M{}: assumed not to move an axis", code));
}

int code_of(const KlartextWord& word, const KlartextBlock& block, const KlartextReading& r) {
  if (word.value < 0 || word.value > 99999 || word.value != std::floor(word.value))
    refuse_klartext(r.program.text, r.program.file, block, word.span.begin,
                    fmt::format("M{} is not a code: expected an integer from 0 to 99999", word.value));
  return static_cast<int>(word.value);
}

}  // namespace

KlartextCodes read_klartext_m(const KlartextBlock& block, KlartextReading& r) {
  KlartextCodes codes;
  for (const KlartextWord& word : r.words)
    if (word.key == "M" && word.literal) read_code(code_of(word, block, r), block, r, codes);
  return codes;
}

}  // namespace counterflex
