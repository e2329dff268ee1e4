#include "report/json/loads_json.hpp"

#include "counterflex/geometry/types.hpp"

namespace counterflex {

namespace {

// Significant: loads differ in size by many orders. More digits of a load would depend on the processor.
constexpr int load_digits = 7, limit_digits = 10;

Json peak_json(const LoadPeak& peak) {
  return {{"largest", significant(peak.value, load_digits)},
          {"line", peak.line},
          {"limit", peak.limit ? significant(*peak.limit, limit_digits) : Json(nullptr)}};
}

Json chain_peaks_json(const LoadsOfChain& chain) {
  Json json = {{"name", chain.name}};
  for (const LoadKind kind : load_kinds) json[std::string(name_of(kind).key)] = peak_json(chain[kind]);
  return json;
}

Json list_of(const LoadsAlong& along, std::size_t chain, LoadKind kind) {
  Json list = Json::array();
  for (const LoadsAtPlace& place : along.places)
    list.push_back(significant(shown_value(place.chains[chain], kind), load_digits));
  return list;
}

Json chain_along_json(const PathLoads& loads, std::size_t chain) {
  Json json = {{"name", loads.chains[chain].name}};
  for (const LoadKind kind : load_kinds)
    json[std::string(name_of(kind).key)] = list_of(loads.along, chain, kind);
  return json;
}

}  // namespace

Json largest_loads_json(const std::optional<PathLoads>& loads) {
  if (!loads) return nullptr;
  Json chains = Json::array();
  for (const LoadsOfChain& chain : loads->chains) chains.push_back(chain_peaks_json(chain));
  return {{"places", loads->along.places.size()},
          {"unsolved", loads->along.unsolved},
          {"chains", std::move(chains)}};
}

std::string loads_json(const std::optional<PathLoads>& loads) {
  if (!loads) return "null";
  Json s_mm = Json::array(), lines = Json::array(), chains = Json::array();
  for (const LoadsAtPlace& place : loads->along.places) {
    s_mm.push_back(number(place.s / mm, 4));
    lines.push_back(place.line);
  }
  for (std::size_t c = 0; c < loads->chains.size(); ++c) chains.push_back(chain_along_json(*loads, c));
  const Json document = {
      {"s_mm", std::move(s_mm)}, {"line", std::move(lines)}, {"chains", std::move(chains)}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace counterflex
