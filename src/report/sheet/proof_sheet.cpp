#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/compensation/offset_window.hpp"
#include "counterflex/files/text.hpp"
#include "counterflex/geometry/types.hpp"
#include "counterflex/program/guard.hpp"
#include "counterflex/report/page.hpp"
#include "report/plot/svg.hpp"
#include "report/text/force_text.hpp"

namespace counterflex {
namespace {

constexpr std::string_view not_stated = "not stated";

/// As many as one page has room for. The JSON document has all.
constexpr std::size_t most_offsets = 4, most_tools = 7, most_restarts = 7, most_files = 8;
constexpr std::size_t most_of_path = 36, most_of_text = 40, most_of_reason = 110;

std::string cell(std::string_view text, std::string_view tag = "td", std::string_view kind = "") {
  return kind.empty() ? fmt::format("<{0}>{1}</{0}>", tag, xml_escaped(text))
                      : fmt::format("<{0} class=\"{2}\">{1}</{0}>", tag, xml_escaped(text), kind);
}

std::string row_of(const std::vector<std::string>& cells, std::string_view tag = "td") {
  std::string text = "<tr>";
  for (const std::string& one : cells) text += cell(one, tag);
  return text + "</tr>\n";
}

std::string fact(std::string_view name, std::string_view key, std::string_view value) {
  return fmt::format("<div><dt>{}</dt><dd data-fact=\"{}\">{}</dd></div>\n", xml_escaped(name), key,
                     xml_escaped(value));
}

std::string section(std::string_view title, std::string_view kind, const std::string& content) {
  return fmt::format("<div class=\"{}\"><h2>{}</h2>\n{}</div>\n", kind, title, content);
}

std::string note(const std::string& text) {
  return "<p>" + xml_escaped(text) + "</p>\n";
}

std::string or_not_stated(const std::string& text) {
  return text.empty() ? std::string(not_stated) : shortened(text, most_of_path);
}

/// Without zeros at its end.
std::string short_fixed(double value, int decimals) {
  std::string text = format_fixed(value, decimals);
  if (text.find('.') == std::string::npos) return text;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string three(const Vector3& values, int decimals) {
  return fmt::format("{}, {}, {}", short_fixed(values[0], decimals), short_fixed(values[1], decimals),
                     short_fixed(values[2], decimals));
}

/// Without its folders: the hash names the file.
std::string file_shown(const std::string& path) {
  if (path == "-") return "standard input or output";
  return shortened(without_controls(path.substr(path.find_last_of('/') + 1)), most_of_path);
}

const InputFile* input_of(const RunReport& report, std::string_view role) {
  for (const InputFile& input : report.facts.inputs)
    if (input.name == role) return &input;
  return nullptr;
}

const OptionValue* option_of(const RunReport& report, std::string_view name) {
  for (const OptionValue& option : report.facts.options)
    if (option.name == name) return &option;
  return nullptr;
}

std::string more(std::size_t count, std::size_t most, std::string_view what) {
  if (count <= most) return "";
  return note(fmt::format("{} more {} are in the JSON document of this report, under \"proof\".",
                          count - most, what));
}

class Sheet {
 public:
  explicit Sheet(const RunReport& report)
      : report_(report), proof_(*report.facts.proof), inch_(report.units.program == LengthUnit::inches) {}

  std::string html() const {
    return "<article id=\"sheet\" aria-labelledby=\"sheet-title\">\n" + head() + warning() +
           "<div class=\"sheet-pair\">\n" + machine() + result() + "</div>\n" + offsets() + tools() +
           restart() + files() + signature() + "</article>\n";
  }

 private:
  /// "0.0041 mm"; with inches for a program in inches.
  std::string length(double value_mm) const {
    std::string text = format_fixed(value_mm, 4) + " mm";
    if (inch_) text += " (" + format_fixed(value_mm / mm_per(LengthUnit::inches), 5) + " in)";
    return text;
  }

  std::string program_name() const {
    if (!proof_.written.empty()) return file_shown(proof_.written.front().path);
    const InputFile* corrected = input_of(report_, "corrected");
    return corrected != nullptr ? file_shown(corrected->path) : "program";
  }

  std::string original_name() const {
    const InputFile* program = input_of(report_, "program");
    return program != nullptr ? file_shown(program->path) : "program";
  }

  std::string head() const {
    return fmt::format(
        "<p class=\"sheet-kind\">Setup sheet</p>\n<h1 id=\"sheet-title\">{} on {}</h1>\n"
        "<dl class=\"sheet-line\">\n{}{}<div><dt>Date and time of the run</dt><dd "
        "class=\"blank\"></dd></div>\n"
        "</dl>\n",
        xml_escaped(program_name()),
        xml_escaped(report_.machine.empty() ? "a machine without a name" : shortened(report_.machine, 48)),
        fact("Made from", "program", original_name()),
        fact("Software", "version", "counterflex " + report_.facts.version));
  }

  std::string warning() const {
    if (!(report_.forces.largest_N > 0 || report_.forces.largest_Nm > 0))
      return "<div class=\"sheet-warning\"><strong>No cutting force is in this program.</strong> " +
             xml_escaped(
                 "It corrects the machine without load. The tool bends away under the cut as before.") +
             "</div>\n";
    std::string text =
        "The program is right only under the cutting force that it was made for. Without the force ";
    if (report_.air)
      text += fmt::format("the tool is off by up to {} (line {} of the input program).",
                          length(report_.air->mm), report_.air->line);
    else
      text += "the tool leaves the programmed path.";
    text += " To look at the motion in the air, run the input program, " + original_name() + ", instead.";
    return "<div class=\"sheet-warning\"><strong>Do not dry-run without load.</strong> " + xml_escaped(text) +
           "</div>\n";
  }

  std::string machine() const {
    const InputFile* file = input_of(report_, "machine");
    return section("Machine", "sheet-part",
                   "<dl>\n" + fact("Name", "machine", or_not_stated(report_.machine)) +
                       fact("Serial number", "serial", or_not_stated(proof_.serial)) +
                       fact("Machine file", "machine-file",
                            file != nullptr ? file_shown(file->path) : std::string(not_stated)) +
                       fact("Date of that file", "date", or_not_stated(proof_.date)) +
                       fact("Tolerance", "tolerance", tolerances()) + fact("Verdict", "verdict", verdict()) +
                       "</dl>\n");
  }

  std::string tolerances() const {
    std::string text = short_fixed(report_.tolerance_mm, 6) + " mm";
    if (report_.as_programmed) text += ", or the band (as programmed there)";
    const OptionValue* tilt = option_of(report_, "tolerance-tilt-deg");
    const OptionValue* spin = option_of(report_, "tolerance-spin-deg");
    if (tilt == nullptr) return text + "; the program does not turn the tool";
    text += "; tilt " + short_fixed(std::get<double>(tilt->value), 6) + " deg";
    return text + "; spin " +
           (spin != nullptr ? short_fixed(std::get<double>(spin->value), 6) + " deg" : std::string("any"));
  }

  std::string verdict() const {
    const std::string word(to_string(report_.verdict));
    return report_.verdict_reason.empty() ? word
                                          : shortened(word + ", " + report_.verdict_reason, most_of_reason);
  }

  std::string largest(const std::optional<DeviationStatistics>& s) const {
    if (!s) return "not known";
    return length(s->max_mm) + (s->bands ? " \u00b1 " + length(s->bands->at_max_mm) : "") +
           fmt::format(", line {}", s->max_line);
  }

  std::string result() const {
    std::string text = "<dl>\n" + fact("Largest before", "before", largest(report_.before)) +
                       fact("Largest after", "after", largest(report_.after)) + worst() +
                       fact("Bands", "bands",
                            report_.uncertainty ? "\u00b1 has k = 2, from [uncertainty] of machine and force"
                                                : "not stated: no [uncertainty] is given") +
                       "</dl>\n";
    text += fmt::format(
        "<p>After is solved, not assumed: the written program was read back, and the machine with its errors "
        "under the force was solved forward at <b data-fact=\"places\">{}</b> places of it. It is what the "
        "model leaves, not the accuracy of the part.</p>\n",
        proof_.solved_places);
    return section("Deviation of the tool tip", "sheet-part", text);
  }

  std::string worst() const {
    if (report_.worst.empty()) return fact("Worst block", "worst", "not known");
    const WorstRow& row = report_.worst.front();
    std::string where = fmt::format("line {}", row.line);
    if (row.at_after.corrected_line > 0)
      where += fmt::format(", written line {}", row.at_after.corrected_line);
    return fact("Worst block", "worst-line", where) +
           fact("", "worst-text", shortened(row.text, most_of_text)) +
           fact("", "worst", length(row.before_mm) + " before, " + length(row.after_mm) + " after");
  }

  std::string window_words() const {
    if (!proof_.window_mm)
      return fmt::format(
          "There is no window: with the offset off by {} mm a block exceeds its tolerance, or an axis its "
          "travel. Set the offset as exactly as you can.",
          window_steps_mm[std::size(window_steps_mm) - 1]);
    std::string text =
        fmt::format("Each of X, Y and Z of the offset may be off by {:g} mm", *proof_.window_mm);
    if (inch_) text += fmt::format(" ({:.5f} in)", *proof_.window_mm / mm_per(LengthUnit::inches));
    if (proof_.window_turns) text += fmt::format(", and each of its angles by {} deg", guarded_angle_deg);
    if (proof_.window_lengths) text += ", and the length of the tool by as much";
    // As `offset_window` judges its places.
    text +=
        ": within this window the program keeps its tolerance, by the model. At places that need not keep it "
        "(as on lines that are not split, on contours under G41, and at corners that the control rounds) the "
        "deviation may exceed the tolerance, or its value with the exact offset if that is larger, by a "
        "tenth of the tolerance.";
    if (report_.feed_moves.unknown > 0) text += " Moves with an unknown deviation are not judged.";
    if (report_.facts.guard)
      text += fmt::format(" The program itself checks {} before its first cut.",
                          report_.facts.guard->guard.active.name.empty()
                              ? "its base"
                              : report_.facts.guard->guard.active.name);
    return text;
  }

  std::string offsets() const {
    std::string rows;
    for (const ProofFacts::Offset& offset : proof_.offsets) {
      if (&offset - proof_.offsets.data() == static_cast<std::ptrdiff_t>(most_offsets)) break;
      const bool turned = offset.rpy_deg.norm() > 1e-9;
      rows += row_of({offset.work.empty() ? "machine coordinates" : shortened(offset.work, 20),
                      three(offset.place_mm, 4), turned ? three(offset.rpy_deg, 5) : "0, 0, 0",
                      offset.shown_mm ? three(*offset.shown_mm, 4) : std::string(not_stated),
                      proof_.window_mm ? fmt::format("\u00b1 {:g}", *proof_.window_mm) : "none"});
    }
    return section("Work offset", "sheet-offsets",
                   "<table>\n" +
                       row_of({"Offset", "X, Y, Z in the machine, mm", "Turned by R, P, Y, deg",
                               "Numbers on the control, mm", "Window, mm"},
                              "th") +
                       rows + "</table>\n" + more(proof_.offsets.size(), most_offsets, "offsets") +
                       "<p data-fact=\"window\">" + xml_escaped(window_words()) + "</p>\n");
  }

  std::string force_uncertainty() const {
    if (report_.uncertainty)
      return fmt::format("The force is uncertain by {:g} % (one standard deviation).",
                         100 * report_.uncertainty->stated.force);
    std::string text = "The uncertainty of the force is not stated.";
    if (report_.sensitivity && report_.sensitivity->higher.unsolved == 0)
      text += fmt::format(" With a force {:g} % higher the tool is off by up to {}.", 100 * force_change,
                          length(report_.sensitivity->higher.deviation.max_mm));
    return text;
  }

  static std::string forces_of(const ProofFacts::Tool& tool) {
    if (tool.forces.empty()) return "none";
    std::string text = tool.forces.front();
    for (std::size_t i = 1; i < tool.forces.size(); ++i) text += "; " + tool.forces[i];
    return shortened(text, 2 * most_of_path);
  }

  std::string tools() const {
    std::string rows;
    const auto in_mm = [](const std::optional<double>& value) {
      return value ? short_fixed(*value, 4) : std::string(not_stated);
    };
    for (const ProofFacts::Tool& tool : proof_.tools) {
      if (&tool - proof_.tools.data() == static_cast<std::ptrdiff_t>(most_tools)) break;
      rows += row_of({tool.number > 0 ? fmt::format("T{}", tool.number) : "not named", in_mm(tool.length_mm),
                      in_mm(tool.radius_mm), forces_of(tool)});
    }
    return section("Tools, and the force that was assumed", "sheet-tools",
                   "<table>\n" + row_of({"Tool", "Length, mm", "Radius, mm", "Force on the tool"}, "th") +
                       rows + "</table>\n" + more(proof_.tools.size(), most_tools, "tools") + "<p>" +
                       fmt::format("Largest force on the path: <b data-fact=\"force\">{}</b>. ",
                                   largest_wrench(report_.forces)) +
                       "<span data-fact=\"force-uncertainty\">" + xml_escaped(force_uncertainty()) +
                       "</span></p>\n");
  }

  std::string restart() const {
    std::string text =
        "The program can always be begun at its top. A line below is proven if everything that the cut "
        "behind "
        "it needs is stated again behind it.";
    if (report_.facts.guard) text += " A later line skips the checks of the program.";
    std::vector<const RestartLine*> lines;  // proven ones first
    for (const bool proven : {true, false})
      for (const RestartLine& line : proof_.restart.lines)
        if (line.missing.empty() == proven) lines.push_back(&line);
    std::string rows;
    for (std::size_t i = 0; i < std::min(lines.size(), most_restarts); ++i) {
      const RestartLine& line = *lines[i];
      rows +=
          row_of({fmt::format("{}", line.line), shortened(line.text, most_of_text),
                  line.missing.empty() ? "yes" : shortened("no, it lacks " + line.missing, most_of_reason)});
    }
    if (rows.empty() || !lines.front()->missing.empty())
      text += " No other line is proven" + (proof_.restart.why_none.empty()
                                                ? std::string(".")
                                                : ": " + proof_.restart.why_none + " of the program.");
    std::string content = "<p data-fact=\"restart\">" + xml_escaped(text) + "</p>\n";
    if (!rows.empty())
      content += "<table>\n" + row_of({"Written line", "Block", "Restart proven"}, "th") + rows +
                 "</table>\n" + more(lines.size(), most_restarts, "lines");
    return section("Restart lines", "sheet-restart", content);
  }

  static std::string role_shown(std::string_view role) {
    if (role == "program") return "Input program";
    if (role == "machine") return "Machine file";
    if (role.starts_with("forces")) return "Force file";
    if (role == "tool-table") return "Tool table";
    if (role == "project") return "Project file";
    if (role == "data-list") return "Data list";
    if (role == "written" || role == "corrected") return "Written program";
    return "Uncertainty file";
  }

  std::string files() const {
    std::vector<InputFile> files = proof_.written;
    for (const InputFile& input : report_.facts.inputs)
      if (input.name != "corrected") files.push_back(input);
    const std::size_t count = files.size();
    std::string rows;
    for (std::size_t i = 0; i < std::min(count, most_files); ++i)
      rows += fmt::format("<tr>{}{}<td class=\"hash\">{}</td></tr>\n", cell(role_shown(files[i].name)),
                          cell(file_shown(files[i].path)), xml_escaped(files[i].sha256));
    for (const std::string_view role : {"forces", "tool-table", "project"})
      if (input_of(report_, role) == nullptr) rows += row_of({role_shown(role), "none", "none"});
    return section("Files, and their SHA-256 as sha256sum prints it", "sheet-files",
                   "<table>\n" + row_of({"File", "Name", "SHA-256"}, "th") + rows + "</table>\n" +
                       more(count, most_files, "files"));
  }

  static std::string signature() {
    return "<div class=\"sheet-sign\"><span>Name</span><span>Date</span><span>Signature</span></div>\n";
  }

  const RunReport& report_;
  const ProofFacts& proof_;
  bool inch_;
};

}  // namespace

std::string proof_sheet(const RunReport& report) {
  return Sheet(report).html();
}

}  // namespace counterflex
