#include "import/urdf/urdf_text.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "counterflex/files/text.hpp"
#include "import/toml_text.hpp"

namespace counterflex::import {
namespace {

std::string attribute(const TiXmlElement& element, const char* name) {
  const char* text = element.Attribute(name);
  return text == nullptr ? "" : text;
}

/// The numbers of an attribute; none where one is not finite, or above 1e9 in size.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  constexpr std::string_view blanks = " \t\r\n";
  for (std::size_t begin = text.find_first_not_of(blanks); begin != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    const auto value = read_number(text.substr(begin, end - begin));
    if (!value || std::abs(*value) > 1e9) return std::nullopt;
    numbers.push_back(*value);
    begin = text.find_first_not_of(blanks, end);
  }
  return numbers;
}

void check_numbers(const UrdfText& urdf, const TiXmlElement& element, const char* name, std::size_t count) {
  const char* text = element.Attribute(name);
  if (text == nullptr) return;
  const auto numbers = numbers_in(text);
  if (!numbers || numbers->size() != count)
    fail(urdf.place(element),
         fmt::format("{} of <{}> is \"{}\"; it must be {}", name, element.Value(), without_controls(text),
                     count == 1 ? "a finite number" : fmt::format("{} finite numbers", count)));
}

void check_children(const UrdfText& urdf, const TiXmlElement& element) {
  for (const TiXmlElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string name = child->Value();
    if (name == "inertial") check_children(urdf, *child);
    if (name == "origin" || name == "axis") check_numbers(urdf, *child, "xyz", 3);
    if (name == "origin") check_numbers(urdf, *child, "rpy", 3);
    if (name == "limit")
      for (const char* bound : {"lower", "upper"}) check_numbers(urdf, *child, bound, 1);
    if (name != "mass") continue;
    check_numbers(urdf, *child, "value", 1);
    if (read_number(attribute(*child, "value")).value_or(0) < 0)
      fail(urdf.place(*child),
           fmt::format("the mass is {} kg; it must not be negative", attribute(*child, "value")));
  }
}

/// Refuses macros, which only the program xacro can expand.
void refuse_xacro(const UrdfText& urdf, const TiXmlElement& element) {
  const std::string_view name = element.Value();
  if (name.starts_with("xacro:"))
    fail(urdf.place(element),
         fmt::format("<{}> is a macro of xacro; expand the file first: xacro FILE.xacro > FILE.urdf",
                     without_controls(name)));
  for (const TiXmlElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    refuse_xacro(urdf, *child);
}

/// Refuses elements in elements in elements: the XML library reads each level with a call of its own. Counts
/// tags; what a comment holds does not count.
void refuse_deep(std::string_view text, const std::string& file) {
  constexpr int deepest = 200;
  int depth = 0;
  for (std::size_t at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
    const std::size_t end = text.substr(at).starts_with("<!--") ? text.find("-->", at) : text.find('>', at);
    if (end == text.npos || at + 1 == text.size()) return;  // the XML library reports it
    const char first = text[at + 1];
    if (first == '/') --depth;
    if (first != '/' && first != '!' && first != '?' && text[end - 1] != '/') ++depth;
    if (depth > deepest)
      fail({file, static_cast<int>(std::count(text.begin(), text.begin() + at, '\n')) + 1, 1},
           fmt::format("elements are nested more than {} deep", deepest));
    at = end;
  }
}

/// Removes shapes, transmissions and extensions: they may hold what urdfdom does not accept.
void keep_kinematics(TiXmlElement& robot) {
  const auto keep = [](TiXmlElement& element, const std::vector<std::string>& kept) {
    for (TiXmlNode* child = element.FirstChild(); child != nullptr;) {
      TiXmlNode* next = child->NextSibling();
      if (child->ToElement() == nullptr ||
          std::find(kept.begin(), kept.end(), child->ValueStr()) == kept.end())
        element.RemoveChild(child);
      child = next;
    }
  };
  keep(robot, {"link", "joint"});
  for (TiXmlElement* link = robot.FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link"))
    keep(*link, {"inertial"});
}

void collect(UrdfText& urdf, const TiXmlElement& robot) {
  for (const TiXmlElement* child = robot.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string kind = child->Value(), name = attribute(*child, "name");
    if (name.empty()) fail(urdf.place(*child), fmt::format("a <{}> has no name", kind));
    auto& list = kind == "link" ? urdf.links : urdf.joints;
    const auto [entry, is_new] = list.emplace(name, child);
    if (!is_new)
      fail(urdf.place(*child), fmt::format("the name of {} \"{}\" is that of line {}, too", kind,
                                           without_controls(name), entry->second->Row()));
    check_children(urdf, *child);
  }
}

/// Keeps the messages of urdfdom instead of printing them.
class KeptMessages : public console_bridge::OutputHandler {
 public:
  KeptMessages() { console_bridge::useOutputHandler(this); }
  ~KeptMessages() override { console_bridge::restorePreviousOutputHandler(); }
  KeptMessages(const KeptMessages&) = delete;
  KeptMessages& operator=(const KeptMessages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) texts_.push_back(text);
  }
  const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
};

/// The joint or link with the longest name that `message` has in brackets or quotes; null without one.
const TiXmlElement* named_in(const std::string& message, const UrdfText& urdf) {
  const TiXmlElement* named = nullptr;
  std::size_t longest = 0;
  for (const auto* list : {&urdf.joints, &urdf.links})
    for (const auto& [name, element] : *list) {
      const bool is_named =
          message.find("[" + name + "]") != message.npos || message.find("'" + name + "'") != message.npos;
      if (!is_named || name.size() <= longest) continue;
      longest = name.size();
      named = element;
    }
  return named;
}

/// The place of the element that the first message with a name names: what is wrong in an element comes
/// before the joint or link that has it.
Location place_named_in(const std::vector<std::string>& messages, const UrdfText& urdf) {
  for (const std::string& message : messages)
    if (const TiXmlElement* named = named_in(message, urdf)) return urdf.place(*named);
  return urdf.robot();
}

/// The link that a joint names in an element; empty if it names none, which the library refuses.
std::string link_of(const TiXmlElement& joint, const char* element) {
  const TiXmlElement* found = joint.FirstChildElement(element);
  const char* name = found == nullptr ? nullptr : found->Attribute("link");
  return name == nullptr ? "" : name;
}

/// Throws where the joints do not form a tree. (The library would keep links of a loop for ever.)
void refuse_loops(const UrdfText& urdf) {
  std::map<std::string, std::string> parent_of;
  for (const auto& [name, joint] : urdf.joints) {
    const std::string child = link_of(*joint, "child");
    if (!child.empty() && !parent_of.emplace(child, link_of(*joint, "parent")).second)
      fail(urdf.place(*joint),
           fmt::format("the link {} is the child of two joints; the joints of a robot must "
                       "form a tree",
                       without_controls(child)));
  }
  for (const auto& [name, joint] : urdf.joints) {
    std::size_t steps = 0;
    for (auto at = parent_of.find(link_of(*joint, "child")); at != parent_of.end();
         at = parent_of.find(at->second))
      if (++steps > parent_of.size())
        fail(urdf.place(*joint),
             fmt::format("the links above the joint {} form a loop; the joints of a robot "
                         "must form a tree",
                         without_controls(name)));
  }
}

}  // namespace

Location UrdfText::robot() const {
  return place(*document.RootElement());
}

void read_urdf_text(std::string_view text, const std::string& file, UrdfText& urdf) {
  urdf.file = file;
  refuse_deep(text, file);
  urdf.document.SetTabSize(1);  // columns in bytes
  urdf.document.Parse(std::string(text).c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (urdf.document.Error())
    fail({file, std::max(urdf.document.ErrorRow(), 1), std::max(urdf.document.ErrorCol(), 1)},
         fmt::format("not XML: {}", urdf.document.ErrorDesc()));
  TiXmlElement* robot = urdf.document.RootElement();
  if (robot == nullptr)
    fail({file, 1, 1}, "the file has no element; a URDF is <robot name=\"...\"> with links and joints");
  refuse_xacro(urdf, *robot);
  if (robot->ValueStr() != "robot")
    fail(urdf.place(*robot), fmt::format("the outer element is <{}>; that of a URDF is <robot>",
                                         without_controls(robot->Value())));
  keep_kinematics(*robot);
  collect(urdf, *robot);
  refuse_loops(urdf);
}

urdf::ModelInterfaceSharedPtr parse_urdf(const UrdfText& urdf) {
  TiXmlPrinter printer;
  urdf.document.Accept(&printer);
  const KeptMessages messages;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(printer.Str());
  if (model != nullptr && messages.texts().empty()) return model;
  const std::string first = messages.texts().empty() ? "" : messages.texts().front();
  fail(place_named_in(messages.texts(), urdf),
       "the URDF library refuses the file: " + without_controls(first));
}

FixedTransform origin_of(const TiXmlElement& owner) {
  FixedTransform fixed;
  const TiXmlElement* origin = owner.FirstChildElement("origin");
  if (origin == nullptr) return fixed;
  const auto read = [&](const char* name, Vector3& values) {
    const auto numbers = numbers_in(attribute(*origin, name));
    if (numbers && numbers->size() == 3) values = Vector3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  };
  read("xyz", fixed.xyz);
  read("rpy", fixed.rpy);
  return fixed;
}

}  // namespace counterflex::import
