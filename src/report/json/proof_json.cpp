#include "report/json/proof_json.hpp"

#include "counterflex/program/guard.hpp"
#include "report/json/summary_json.hpp"

namespace counterflex {
namespace {

constexpr int proof_digits = 7;  // 1e-7 mm, 1e-7 deg

Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

Json proof_offsets_json(const std::vector<ProofFacts::Offset>& offsets) {
  Json list = Json::array();
  for (const ProofFacts::Offset& offset : offsets)
    list.push_back(
        {{"work", text_or_null(offset.work)},
         {"xyz_mm", numbers(offset.place_mm, proof_digits)},
         {"rpy_deg", numbers(offset.rpy_deg, proof_digits)},
         {"offset_mm", offset.shown_mm ? numbers(*offset.shown_mm, proof_digits) : Json(nullptr)}});
  return list;
}

Json proof_tools_json(const std::vector<ProofFacts::Tool>& tools) {
  Json list = Json::array();
  for (const ProofFacts::Tool& tool : tools)
    list.push_back({{"tool", tool.number},
                    {"length_mm", optional_number(tool.length_mm)},
                    {"radius_mm", optional_number(tool.radius_mm)},
                    {"forces", tool.forces}});
  return list;
}

Json restart_json(const RestartLines& restart) {
  Json list = Json::array();
  for (const RestartLine& line : restart.lines)
    list.push_back({{"line", line.line},
                    {"tool", line.tool},
                    {"text", line.text},
                    {"missing", text_or_null(line.missing)}});
  return {{"why_none", text_or_null(restart.why_none)}, {"lines", std::move(list)}};
}

}  // namespace

Json proof_json(const ProofFacts& proof) {
  Json written = Json::array();
  for (const InputFile& file : proof.written)
    written.push_back({{"path", file.path}, {"sha256", file.sha256}});
  return {{"serial", text_or_null(proof.serial)},
          {"date", text_or_null(proof.date)},
          {"window_mm", optional_number(proof.window_mm)},
          {"window_of_lengths", proof.window_lengths},
          {"window_deg", proof.window_turns ? Json(guarded_angle_deg) : Json(nullptr)},
          {"window_places", proof.window_places},
          {"offsets", proof_offsets_json(proof.offsets)},
          {"tools", proof_tools_json(proof.tools)},
          {"restart", restart_json(proof.restart)},
          {"solved_places", proof.solved_places},
          {"written", std::move(written)}};
}

}  // namespace counterflex
