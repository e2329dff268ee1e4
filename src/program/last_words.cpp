#include "counterflex/program/last_words.hpp"

#include "counterflex/program/program_reader.hpp"

namespace counterflex {

namespace {

using LastWords = std::array<std::optional<std::size_t>, 3>;

void find_words(const Program& window, std::size_t begin, std::size_t end, LastWords& last) {
  for (const Move& move : window.moves)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (move.words[axis] && begin + move.block.begin < end) last[axis] = begin + move.block.begin;
}

}  // namespace

LastWords last_words_before(std::size_t end, FileReader& bytes, const std::string& file,
                            const ReadOptions& options) {
  LastWords last;
  if (end == 0) return last;
  try {
    ProgramReader reader(bytes, file, options);
    for (std::size_t begin = 0; begin < end && reader.next(); begin += reader.window().text.size())
      find_words(reader.window(), begin, end, last);
  } catch (const InputError&) {
    return last;
  }
  return last;
}

}  // namespace counterflex
