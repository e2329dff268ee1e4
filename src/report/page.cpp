#include "counterflex/report/page.hpp"

#include <fmt/core.h>

#include "counterflex/files/files.hpp"
#include "counterflex/files/text.hpp"
#include "report/json/json_numbers.hpp"
#include "report/page_assets.hpp"
#include "report/plot/svg.hpp"

namespace counterflex {
namespace {

using Take = std::function<void(std::string_view)>;

/// Escapes JSON for a script element: every `<` is in a string.
void write_json(std::string_view json, const Take& take) {
  for (std::size_t from = 0; from < json.size();) {
    const std::size_t sign = std::min(json.find('<', from), json.size());
    take(json.substr(from, sign - from));
    if (sign < json.size()) take("\\u003c");
    from = sign + 1;
  }
}

std::string sources(std::span<const std::string_view> texts) {
  std::string list;
  for (const std::string_view text : texts) list.append(" '").append(integrity(text)).append("'");
  return list;
}

void write_policy(const std::string& sheet, const Take& take) {
  const std::string_view style = sheet_style();
  take(fmt::format(
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src{}; "
      "style-src{}{}; img-src data: blob:; base-uri 'none'; form-action 'none'\">\n",
      sources(page_scripts()), sources(page_styles()), sheet.empty() ? "" : sources(std::span(&style, 1))));
}

void write_elements(const char* name, std::span<const std::string_view> texts, const Take& take) {
  for (const std::string_view text : texts) {
    take(fmt::format("<{}>", name));
    take(text);
    take(fmt::format("</{}>\n", name));
  }
}

void write_text(const std::string& text, const Take& take) {
  write_json(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace), take);
}

void write_data(const std::vector<PageRun>& runs, const std::string& conclusion, const Take& take) {
  take(
      "<script type=\"application/json\" id=\"counterflex-data\">{\"schema\": \"counterflex-page 1\", "
      "\"runs\": [");
  const char* separator = "\n";
  for (const PageRun& run : runs) {
    take(separator);
    take("{\"name\": ");
    write_text(run.name, take);
    for (const auto& [key, json] : {std::pair{"report", &run.report},
                                    {"curves", &run.curves},
                                    {"loads", &run.loads},
                                    {"machine", &run.machine},
                                    {"source", &run.source}}) {
      take(fmt::format(",\n\"{}\": ", key));
      write_json(*json, take);
    }
    take("}");
    separator = ",\n";
  }
  take("]");
  if (!conclusion.empty()) {
    take(",\n\"conclusion\": ");
    write_text(conclusion, take);
  }
  take("}</script>\n");
}

/// Without its folder.
std::string file_of(const RunReport& report, std::string_view role) {
  for (const InputFile& input : report.facts.inputs)
    if (input.name == role)
      return input.path == "-" ? "standard input"
                               : without_controls(input.path.substr(input.path.find_last_of('/') + 1));
  return "program";
}

}  // namespace

void write_page(const std::string& title, const std::vector<PageRun>& runs, const Take& take,
                const std::string& conclusion, const std::string& sheet) {
  std::string_view rest = page_template();
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, std::min(rest.find('\n'), rest.size() - 1) + 1);
    rest.remove_prefix(line.size());
    if (line == "<!-- counterflex: csp -->\n")
      write_policy(sheet, take);
    else if (line == "<!-- counterflex: title -->\n")
      take("<title>" + xml_escaped(title) + "</title>\n");
    else if (line == "<!-- counterflex: styles -->\n") {
      const std::string_view style = sheet_style();
      write_elements("style", page_styles(), take);
      if (!sheet.empty()) write_elements("style", std::span(&style, 1), take);
    } else if (line == "<!-- counterflex: sheet -->\n")
      take(sheet);
    else if (line == "<!-- counterflex: data -->\n")
      write_data(runs, conclusion, take);
    else if (line == "<!-- counterflex: offsets -->\n")
      for (const PageRun& run : runs) take(run.offsets);
    else if (line == "<!-- counterflex: scripts -->\n")
      write_elements("script", page_scripts(), take);
    else
      take(line);
  }
}

std::string page_title(const RunReport& report) {
  std::string name = file_of(report, "program");
  if (report.command == Command::verify) name = file_of(report, "corrected") + " for " + name;
  return report.machine.empty() ? name : name + " on " + report.machine;
}

}  // namespace counterflex
