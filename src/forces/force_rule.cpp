#include <algorithm>

#include "counterflex/forces/cutting_model.hpp"
#include "counterflex/forces/forces.hpp"

namespace counterflex {

ForceRank rank(const ForceSelector& selector) {
  if (selector.lines || selector.blocks) return ForceRank::place;
  if (selector.operation) return ForceRank::operation;
  return selector.tool ? ForceRank::tool : ForceRank::program;
}

ForceRank rank(const ForceRule& rule) {
  return std::holds_alternative<ForceProfile>(rule.content) ? ForceRank::place : rank(rule.selector);
}

ForceFrame frame_of(const ForceRule& rule) {
  if (const auto* force = std::get_if<ConstantForce>(&rule.content)) return force->frame;
  if (const auto* profile = std::get_if<ForceProfile>(&rule.content)) return profile->frame;
  return ForceFrame::feed;
}

bool at_platform(const ForceRule& rule) {
  if (const auto* force = std::get_if<ConstantForce>(&rule.content)) return force->at_platform;
  const auto* profile = std::get_if<ForceProfile>(&rule.content);
  return profile != nullptr && profile->at_platform;
}

bool is_zero(const ForceRule& rule) {
  if (const auto* force = std::get_if<ConstantForce>(&rule.content)) return force->F.isZero(0);
  if (const auto* response = std::get_if<CutResponse>(&rule.content))
    return response->F_c.isZero(0) && response->F_e.isZero(0) && response->T_c.isZero(0) &&
           response->T_e.isZero(0);
  return std::get<ForceProfile>(rule.content).rows.all_zero();
}

bool acts_at_platform(const ForceSource& source) {
  return std::any_of(source.rules.begin(), source.rules.end(),
                     [](const ForceRule& rule) { return at_platform(rule) && !is_zero(rule); });
}

bool needs_tool_axes(const ForceSource& source) {
  for (const ForceRule& rule : source.rules)
    if (frame_of(rule) == ForceFrame::tool || frame_of(rule) == ForceFrame::feed) return true;
  return false;
}

}  // namespace counterflex
