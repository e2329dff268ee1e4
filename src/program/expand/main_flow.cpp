#include "program/expand/main_flow.hpp"

#include <algorithm>

#include "program/expand/expand.hpp"
#include "program/expand/structures.hpp"
#include "program/siemens/signs.hpp"
#include "program/text/scanner.hpp"

namespace counterflex {
namespace {

/// A Sinumerik's program ends with RET, M2, M17 or M30, with or without '/'.
bool ends_sinumerik(const Block& block) {
  return block.statement == Statement::end || ends_program(block) || find_m(block, 17) != nullptr;
}

}  // namespace

std::optional<Definition> definition_at(const ProgramText& program, const Block& block) {
  const auto& [text, file, dialect, numbered_programs] = program;
  SubprogramName name;
  if (dialect.sinumerik_words) return std::nullopt;
  if (dialect.o_words) {
    if (!is_word(part(text, block.flow_keyword), "SUB") || !empty(block.block_delete)) return std::nullopt;
    name = {NameKind::word, normal_name(part(text, block.flow_name))};
  } else if (!is_program_number(block) || numbered_programs < 2) {
    return std::nullopt;
  }
  Definition definition = read_definition(text, file, dialect, name, {block.span.begin, block.text_line});
  return definition.ends ? std::optional(std::move(definition)) : std::nullopt;
}

MainFlow read_main_flow(const ProgramText& program) {
  const auto& [text, file, dialect, numbered_programs] = program;
  MainFlow main;
  if (!may_execute(dialect)) return main;
  const bool jumps =
      (dialect.sinumerik_words && siemens_jumps(text)) || text.find("GOTO") != std::string_view::npos ||
      text.find("goto") != std::string_view::npos || text.find("Goto") != std::string_view::npos;
  Block block;
  Structures structures;
  bool opened = false, has_words = false, ended = false;
  while (next_line(text, block)) {
    if (!ended)
      lex(text, file, dialect, block);
    else if (!lexes(text, file, dialect, block))
      break;
    const bool other_program = dialect.macro_words && is_program_number(block);
    if (((opened || has_words) && block.percent) || (ended && other_program)) break;
    if (const auto definition = definition_at(program, block)) {
      if (!structures.open.empty())
        throw UnknownFlow{block.line, "a subprogram is defined in a condition or a loop"};
      block = before(definition->after);
      main.end = definition->after.at;
      continue;
    }
    if (has_words && other_program) break;
    opened = opened || block.percent;
    has_words = has_words || !block.words.empty();
    add_flow(text, dialect, block, jumps, main.flow);
    follow_structures(text, dialect, block, structures);
    main.end = block.line_end.end;
    ended = ended || (!dialect.sinumerik_words && ends_main(block, dialect) && structures.open.empty());
    if (ended && dialect.o_words) break;
  }
  main.any = has_flow(main.flow);
  join_structures(main.flow);
  return main;
}

bool ends_main(const Block& block, const Dialect& dialect) {
  if (dialect.sinumerik_words) return ends_sinumerik(block);
  return (ends_program(block) || find_m(block, 99) != nullptr) && empty(block.block_delete);
}

}  // namespace counterflex
