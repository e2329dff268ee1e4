#pragma once
/// The little of SVG that a plot needs. Coordinates in px, y downwards.
#include <string>
#include <string_view>

namespace counterflex {

/// `text` as the content of an element or an attribute. What is no UTF-8, and what XML does not allow,
/// becomes U+FFFD.
std::string xml_escaped(std::string_view text);

/// At most `most` characters of `text`, the last three of them dots where there are more.
std::string shortened(std::string_view text, std::size_t most);

/// Appends a coordinate, rounded to a tenth.
void append_px(std::string& svg, double value);

enum class Anchor { start, middle, end };

/// A text with its base line at `y`. `attributes` begin with a blank where there are any.
std::string svg_text(double x, double y, Anchor anchor, std::string_view text,
                     std::string_view attributes = "");

/// A straight line.
std::string svg_line(double x1, double y1, double x2, double y2, std::string_view attributes = "");

}  // namespace counterflex
