#include "machine/create/words.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace counterflex::made {
namespace {

std::string_view name_of(NumberSource source) {
  return source == NumberSource::measured    ? "measured"
         : source == NumberSource::catalogue ? "catalogue"
                                             : "prior";
}

/// A TOML string.
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

}  // namespace

std::string number(double value) {
  return fmt::format("{:.15g}", value == 0 ? 0 : value);  // never "-0"
}

std::string triple(const Vector3& v) {
  return fmt::format("[{}, {}, {}]", number(v.x()), number(v.y()), number(v.z()));
}

std::string turned(const Matrix3& R) {
  const Eigen::Quaterniond q(R);
  return fmt::format("quat_wxyz = [{}, {}, {}, {}]", number(q.w()), number(q.x()), number(q.y()),
                     number(q.z()));
}

std::string sigma(double value) {
  return fmt::format("sigma = {:.3g}", value);
}

std::string percent(double value) {
  return fmt::format("prior_percent = {:.3g}", value);
}

std::string stated(std::string_view parameter, const Knowledge& knowledge) {
  return fmt::format("\"{}\" = {{ {}, source = \"{}\", note = {} }}\n", parameter, knowledge.deviation,
                     name_of(knowledge.source), quoted(knowledge.note));
}

std::string stated_errors(std::string_view slot, const std::vector<std::string_view>& components,
                          const Knowledge& position, const Knowledge& orientation) {
  std::string text;
  for (const std::string_view component : components)
    text +=
        stated(fmt::format("{}.{}", slot, component), component.ends_with("_mm") ? position : orientation);
  return text;
}

std::string title(const Title& title) {
  return comment(fmt::format("Made by `{}`. {}", title.command, title.what)) +
         fmt::format("format = \"counterflex-machine 1\"\nname = {}\ncontrolled = [{}]\n", quoted(title.name),
                     title.controlled);
}

std::string parameters_header() {
  return "\n" +
         comment(
             "Where the numbers are from, and how well they are known. `sigma` is a standard deviation in "
             "the unit "
             "of the name, prior_percent one in percent of the value. Values are in the elements above; a "
             "`value` "
             "here replaces them. When you have measured a number, enter it with its sigma and source = "
             "\"measured\". "
             "`counterflex check --parameters` lists all numbers.") +
         "[parameters]\n";
}

std::string work_offset(std::string_view name, const Vector3& at_mm) {
  return fmt::format(
      "\n[work.{}]  # program zero in machine coordinates: copy it from the control\n"
      "xyz_mm = {}\n"
      "# State how you found it, with one of these lines:\n"
      "# datum = {{ touched_at_mm = [0, 0, 0] }}   # touched off with this machine at this point of the "
      "program\n"
      "# datum = \"machine\"                       # measured independently of this machine\n",
      name, triple(at_mm));
}

std::string comment(std::string_view text) {
  constexpr std::size_t width = 118;
  std::string result;
  for (std::size_t column = 0; !text.empty();) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (column == 0 || column + 1 + word.size() > width) {
      result += column == 0 ? "#" : "\n#";
      column = 1;
    }
    result.append(" ").append(word);
    column += 1 + word.size();
  }
  return result + "\n";
}

AxisRange travel_of(const MachineFacts& facts, char axis, AxisRange otherwise) {
  const auto found = facts.travel.find(axis);
  return found == facts.travel.end() ? otherwise : found->second;
}

}  // namespace counterflex::made
