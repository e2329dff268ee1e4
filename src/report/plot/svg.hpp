#pragma once
/// SVG elements of a plot. Coordinates are in px, y downwards.
#include <string>
#include <string_view>

namespace counterflex {

/// `text` as the content of an element or an attribute. Bytes that are not UTF-8 and characters that XML does
/// not allow become U+FFFD.
std::string xml_escaped(std::string_view text);

/// At most `most` characters of `text`; a longer text ends in three dots.
std::string shortened(std::string_view text, std::size_t most);

/// Appends a coordinate, rounded to a tenth.
void append_px(std::string& svg, double value);

enum class Anchor { start, middle, end };

/// A text with its base line at `y`. `attributes` begin with a blank or are empty.
std::string svg_text(double x, double y, Anchor anchor, std::string_view text,
                     std::string_view attributes = "");

/// A straight line.
std::string svg_line(double x1, double y1, double x2, double y2, std::string_view attributes = "");

}  // namespace counterflex
