#include "program/robot/yaskawa/motion.hpp"

#include <fmt/format.h>

#include <array>

#include "program/text/lex.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

constexpr auto moves = std::to_array<std::string_view>({"MOVJ", "MOVL", "MOVC", "MOVS", "IMOV"});
/// Words that change neither the path nor the end of a step.
constexpr auto harmless =
    std::to_array<std::string_view>({"VJ", "ACC", "DEC", "VMAX", "SPDL", "NWAIT", "ENWAIT", "T", "DIS"});
/// Words that start the next instruction before the end of the step.
constexpr auto timed = std::to_array<std::string_view>({"NWAIT", "ENWAIT", "T", "DIS"});

/// The number that is the whole text behind byte `at` of a word.
std::optional<RobotNumber> value_of(std::string_view text, std::size_t at, Span word) {
  const auto number = at < word.end ? number_at(text, at) : std::nullopt;
  return number && number->span.end == word.end ? number : std::nullopt;
}

bool read_name(std::string_view text, Span word, JbiMotion& motion) {
  const auto name = jbi_name(text, word);
  if (!name) return false;
  switch (name->family) {
    case JbiFamily::robot:
    case JbiFamily::robot_variable:
      if (motion.target) motion.why = "the step has two targets";
      motion.target = name;
      break;
    case JbiFamily::base:
      motion.base = name;
      break;
    case JbiFamily::station:
      motion.station = name;
      break;
    case JbiFamily::base_variable:
    case JbiFamily::station_variable:
      motion.why = fmt::format("'{}' moves the base or a station to a variable", part(text, word));
      break;
  }
  return true;
}

/// LP000, P[I000], LP[B000] and the same of base axes and stations.
bool is_computed_target(std::string_view word) {
  const std::size_t end = word.find_first_of("0123456789[");
  constexpr auto names =
      std::to_array<std::string_view>({"P", "LP", "BP", "LBP", "EX", "LEX"});  // P with digits is a name
  return end != std::string_view::npos && is_among(word.substr(0, end), names);
}

void read_word(std::string_view text, Span span, JbiMotion& motion) {
  const std::string word = jbi_word(part(text, span));
  const std::size_t equals = std::min(word.find('='), word.size());
  const std::string key = word.substr(0, equals);
  const auto value = value_of(text, span.begin + equals + 1, span);
  if (read_name(text, span, motion)) return;
  if (key == "V") {
    motion.speed_mm_s = value ? value->value : 0;
  } else if (key == "VR" || key == "VE") {
    motion.speed_mm_s = 0;
  } else if (key == "PL") {
    motion.passes = value && value->value > 0;
  } else if (key == "CR") {
    motion.corner_radius = value;
  } else if (key == "FPT") {
    motion.is_fixed_point = true;
  } else if (is_among(key, harmless)) {
    motion.stays_whole = motion.stays_whole || is_among(key, timed);
  } else if (equals == word.size() && is_computed_target(word)) {
    motion.computed_target = part(text, span);
  } else if (key == "UNTIL") {
    motion.why = "UNTIL ends the step at run time";
  } else if (motion.why.empty()) {
    motion.why = fmt::format("the word '{}' of {} is not supported", part(text, span), motion.head);
  }
}

}  // namespace

bool is_jbi_move(std::string_view word) {
  while (!word.empty() && word.front() == '+') word.remove_prefix(1);
  return is_among(word, moves) || (word.starts_with('S') && is_among(word.substr(1), moves));
}

JbiMotion jbi_motion(std::string_view text, Span code) {
  const std::vector<Span> words = jbi_words(text, code);
  JbiMotion motion{.head = jbi_word(part(text, words.front()))};
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (text[words[i].begin] == '+') {
      motion.why = "the step moves a second group";
      break;
    }
    if (jbi_word(part(text, words[i])) == "UNTIL") {  // a condition follows
      motion.why = "UNTIL ends the step at run time";
      break;
    }
    read_word(text, words[i], motion);
  }
  return motion;
}

}  // namespace counterflex
