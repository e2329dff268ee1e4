#include "report/plot/svg.hpp"

#include <fmt/core.h>

#include "counterflex/files/text.hpp"
#include "report/json/fixed_digits.hpp"

namespace counterflex {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

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
  std::size_t kept = 0, count = 0;  // bytes kept before the dots; number of characters
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
