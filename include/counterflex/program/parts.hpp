#pragma once
/// Robot programs divided into parts that a main program calls.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace counterflex {

/// A program of its own: its name in the control, which is also the stem of its file.
struct ProgramPart {
  std::string name;
  std::string text;
};

/// Whether programs of `dialect` can be divided: FANUC TP, KUKA KRL, ABB RAPID and Yaskawa INFORM.
bool can_be_divided(std::string_view dialect);

/// Why they cannot; empty if they can.
std::string_view why_not_divided(std::string_view dialect);

/// Divides the program `text`, which is larger than `most` points, into parts NAME_1, NAME_2 ... with at most
/// `most` points each. The first element is the main program NAME, which calls them in order. A part ends
/// before a joint move where there is one. The parts are joined again, and must give `text`.
///
/// Throws `InputError` (ErrorKind::program_text) with the line of `text` for a statement that a part cannot
/// have: it jumps, or needs data of the main program.
std::vector<ProgramPart> divide_program(const std::string& file, std::string_view dialect,
                                        const std::string& text, std::size_t most);

}  // namespace counterflex
