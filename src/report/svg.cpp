#include "svg.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "fixed_digits.hpp"

namespace counterflex {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

/// How many bytes the character at the beginning of `text` has, by its first one; 0: none begins so.
std::size_t utf8_length(std::string_view text) {
  const auto byte = static_cast<unsigned char>(text.front());
  if (byte < 0x80) return 1;
  if (byte >= 0xC2 && byte < 0xE0) return 2;
  if (byte >= 0xE0 && byte < 0xF0) return 3;
  return byte >= 0xF0 && byte < 0xF5 ? 4 : 0;
}

/// Neither a longer form of a shorter character, nor a surrogate, nor beyond the last one.
bool allowed_second_byte(std::string_view character) {
  const auto first = static_cast<unsigned char>(character[0]),
             second = static_cast<unsigned char>(character[1]);
  if (first == 0xE0) return second >= 0xA0;
  if (first == 0xED) return second < 0xA0;
  if (first == 0xF0) return second >= 0x90;
  return first != 0xF4 || second < 0x90;
}

/// The character at the beginning of `text`, or its first byte where there is none.
std::string_view first_character(std::string_view text) {
  const std::size_t length = utf8_length(text);
  if (length <= 1 || text.size() < length) return text.substr(0, 1);
  const std::string_view rest = text.substr(1, length - 1);
  const bool whole = std::all_of(rest.begin(), rest.end(),
                                 [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; });
  return text.substr(0, whole && allowed_second_byte(text) ? length : 1);
}

std::string_view xml_form(std::string_view character) {
  if (character == "&") return "&amp;";
  if (character == "<") return "&lt;";
  if (character == ">") return "&gt;";
  if (character == "\"") return "&quot;";
  if (character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF") return replacement;
  const auto byte = static_cast<unsigned char>(character.front());
  const bool printable = byte >= 0x20 && byte != 0x7F;
  return character.size() > 1 || (printable && byte < 0x80) ? character : replacement;
}

const char* anchor_name(Anchor anchor) {
  return anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
}

}  // namespace

std::string xml_escaped(std::string_view text) {
  std::string result;
  for (std::string_view character; !text.empty(); text.remove_prefix(character.size())) {
    character = first_character(text);
    result += xml_form(character);
  }
  return result;
}

std::string shortened(std::string_view text, std::size_t most) {
  std::string result;
  std::size_t kept = 0, count = 0;  // bytes of the result that stay beside the dots; characters
  for (std::string_view rest = text; !rest.empty(); ++count) {
    if (count == most) return result.substr(0, kept) + "...";
    const std::string_view character = first_character(rest);
    if (count + 3 <= most) kept = result.size();
    result += character;
    rest.remove_prefix(character.size());
  }
  return result;
}

void append_px(std::string& svg, double value) {
  append_fixed(svg, value, 1);
}

std::string svg_text(double x, double y, Anchor anchor, std::string_view text, std::string_view attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor_name(anchor), attributes, xml_escaped(text));
}

std::string svg_line(double x1, double y1, double x2, double y2, std::string_view attributes) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"{}/>\n", x1, y1, x2, y2,
                     attributes);
}

}  // namespace counterflex
