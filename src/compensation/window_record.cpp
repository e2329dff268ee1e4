#include "window_record.hpp"

#include "counterflex/files/bytes.hpp"
#include "waypoint_bytes.hpp"

namespace counterflex {
namespace {

static_assert(sizeof(Rewritten) == 96 && sizeof(OtherMoves) == 32 && sizeof(LeftAlone) == 48,
              "what is added to the result of a window is to be kept, too");

void put_left_alone(const LeftAlone& block, std::string& bytes) {
  put(block.line, bytes);
  put(std::string_view(block.why), bytes);
  put(block.machine_position, bytes);
  put(block.text_line, bytes);
}

LeftAlone get_left_alone(BytesIn& bytes) {
  LeftAlone block;
  block.line = bytes.get<int>();
  block.why = bytes.get_text();
  block.machine_position = bytes.get<bool>();
  block.text_line = bytes.get<int>();
  return block;
}

// The same list of counts serves both ways.
template <typename Result, typename Take>
void each_count(Result& result, const Take& take) {
  take(result.counts.changed_words);
  take(result.counts.inserted_words);
  take(result.counts.inserted_blocks);
  take(result.counts.unnumbered_pieces);
  take(result.counts.first_unnumbered_line);
  take(result.corrected_moves);
  take(result.other_moves.grouped);
  take(result.other_moves.held);
  take(result.other_moves.in_part);
  take(result.other_moves.left);
  take(result.largest_correction);
  take(result.largest_correction_line);
}

void put_result(const Compensation& result, std::string& bytes) {
  put(std::string_view(result.text), bytes);
  put_waypoints(result.waypoints, bytes);
  put(result.left_alone.size(), bytes);
  for (const LeftAlone& block : result.left_alone) put_left_alone(block, bytes);
  each_count(result, [&](const auto& count) { put(count, bytes); });
}

void get_result(BytesIn& bytes, Compensation& result) {
  result.text = bytes.get_text();
  result.waypoints = get_waypoints(bytes);
  constexpr std::size_t least_bytes = 17;
  result.left_alone.resize(bytes.get_count(least_bytes));
  for (LeftAlone& block : result.left_alone) block = get_left_alone(bytes);
  each_count(result, [&](auto& count) { count = bytes.get<std::remove_reference_t<decltype(count)>>(); });
}

}  // namespace

std::string to_bytes(const WindowRecord& record) {
  std::string bytes;
  put(record.index, bytes);
  put(record.bytes, bytes);
  put(std::string_view(record.start), bytes);
  put_window_state(record.entry, bytes);
  put_window_state(record.exit, bytes);
  put(std::string_view(record.commands), bytes);
  put_result(record.result, bytes);
  return bytes;
}

std::optional<WindowRecord> window_record_of(std::string_view bytes) {
  BytesIn in(bytes);
  WindowRecord record;
  record.index = in.get<std::size_t>();
  record.bytes = in.get<std::size_t>();
  record.start = in.get_text();
  record.entry = get_window_state(in);
  record.exit = get_window_state(in);
  record.commands = in.get_text();
  get_result(in, record.result);
  if (!in.is_complete()) return std::nullopt;
  return record;
}

}  // namespace counterflex
