#include "program/expand_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/constant_expression.hpp"
#include "program/expand_call.hpp"
#include "program/expand_lines.hpp"
#include "program/expand_structures.hpp"
#include "program/scanner.hpp"

namespace counterflex {
namespace {

constexpr std::size_t arguments_of_call = 30;  // those that are not given are zero
constexpr std::size_t deepest_calls = 100;

/// The body that is being copied, or the program itself.
struct Copying {
  const Definition* definition = nullptr;
  std::vector<double> parameters{};  ///< #1 to #30 of an O-word's body
  int called_from = 0;
};

std::string_view whole_line(std::string_view text, const Block& block) {
  return text.substr(block.span.begin, block.line_end.end - block.span.begin);
}

class Expander {
 public:
  Expander(std::string_view text, const std::string& file, const Dialect& dialect, std::string_view why_none)
      : text_(text),
        file_(file),
        dialect_(dialect),
        why_none_(why_none),
        definitions_(find_definitions(text, file, dialect)),
        lines_{{}, line_end_of(text)} {
    numbered_programs_ = std::count_if(definitions_.begin(), definitions_.end(), [](const auto& named) {
      return named.first.kind == NameKind::program;
    });
    reads_results_ = text.find("<_value") != std::string_view::npos;
    expansion_.file_lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    if (!text.empty() && text.back() != '\n') ++expansion_.file_lines;
  }

  ExpandedText run() {
    const LinePlace rest = copy_program();
    if (rest.at < text_.size()) lines_.append(text_.substr(rest.at), rest.line, 0);
    expansion_.lines = std::move(lines_.runs);
    // Where nothing outside them moves, definitions may be the program (M99 runs it over and over), or be
    // called from other files.
    if (!other_calls_ && moves_) expansion_.unused = std::move(kept_);
    return {std::move(lines_.text), std::move(expansion_), seeks_numbers_};
  }

 private:
  /// Everything up to the end of the program, definitions as they stand. Returns where the rest begins.
  LinePlace copy_program() {
    Block block;
    bool opened = false, said = false;
    while (next_line(text_, block)) {
      lex(text_, file_, dialect_, block);
      if (block.percent && (opened || said)) return {block.span.begin, block.line};
      opened = opened || block.percent;
      said = said || !block.words.empty();
      if (const auto definition = definition_at(block)) {
        keep(*definition);
        block = before(definition->after);
        continue;
      }
      follow_structures(text_, dialect_, block, structures_);
      copy_block(block, {});
      const bool ends = ends_program(block) || find_m(block, 99) != nullptr;
      if (ends && empty(block.block_delete) && structures_.open.empty()) break;
    }
    return {block.line_end.end, block.line + 1};
  }

  std::optional<Definition> definition_at(const Block& block) const {
    SubprogramName name;
    if (dialect_.o_words) {
      if (!is_word(part(text_, block.flow_keyword), "SUB")) return std::nullopt;
      name = {NameKind::word, normal_name(part(text_, block.flow_name))};
    } else if (!is_program_number(block) || numbered_programs_ < 2) {
      return std::nullopt;  // a single program that ends with M99 runs over and over
    }
    Definition definition = read_definition(text_, file_, dialect_, name, {block.span.begin, block.line});
    return definition.ends ? std::optional(std::move(definition)) : std::nullopt;
  }

  void keep(const Definition& d) {
    const std::size_t begin = lines_.text.size();
    append_lines(text_, d.begin.at, d.begin.line, d.after.at, lines_);
    kept_.push_back({begin, lines_.text.size()});
  }

  /// Copies a block, or what it calls. Says why the copy of a body cannot go on.
  std::string copy_block(const Block& block, const Copying& copying) {
    note_moves(block);
    const auto call = call_in(text_, dialect_, block);
    if (!call) return copy_words(block, copying);
    const std::string why = expand(*call, block, copying);
    // What a call in a body of LinuxCNC says would count otherwise in another place.
    if (why.empty() || (copying.definition != nullptr && dialect_.o_words)) return why;
    other_calls_ = true;
    seeks_numbers_ = seeks_numbers_ || call->name.kind == NameKind::block;
    lines_.append(whole_line(text_, block), block.line, copying.called_from);
    expansion_.calls_left.push_back({lines_.count, why});
    return {};
  }

  /// A block without a call, with the values of its expressions in the body of an O-word.
  std::string copy_words(const Block& block, const Copying& copying) {
    other_calls_ = other_calls_ || may_call(block, dialect_);
    seeks_numbers_ = seeks_numbers_ || (find_m(block, 99) != nullptr && find_letter(block, 'P') != nullptr);
    std::string line;
    std::size_t copied = block.span.begin;
    for (const Word& word : block.words) {
      if (word.literal || copying.parameters.empty()) continue;
      const auto value = constant_value(part(text_, word.number), copying.parameters);
      if (!value)
        return fmt::format("{}{} in line {} of its body is no number that the call gives", word.letter,
                           part(text_, word.number), block.line);
      line.append(text_, copied, word.number.begin - copied).append(shortest_text(*value));
      copied = word.number.end;
    }
    line.append(text_, copied, block.line_end.end - copied);
    lines_.append(line, block.line, copying.called_from);
    return {};
  }

  /// Puts the bodies in the place of the call, or says why not and leaves nothing behind.
  std::string expand(const SubprogramCall& call, const Block& block, const Copying& copying) {
    if (!why_none_.empty()) return std::string(why_none_);
    if (!call.why_not.empty()) return call.why_not;
    if (!structures_.open.empty()) return "it stands in a condition or a loop";
    long repeats = call.repeats;
    const auto [definition, why] = find(call, repeats);
    if (definition == nullptr) return why;
    refuse_depth(*definition, call, block);
    Copying body{definition, {}, block.line};
    if (const std::string unknown = set_parameters(call, copying, body); !unknown.empty()) return unknown;

    const LinesMark mark = mark_of(lines_);
    const std::size_t calls = expansion_.calls, left = expansion_.calls_left.size();
    // What else the block says is done first.
    if (const std::string rest = line_without(text_, dialect_, block, call.dropped); !rest.empty())
      lines_.append(rest, block.line, copying.called_from);
    const std::string failed = copy_bodies(body, repeats, call, block);
    if (failed.empty()) return {};
    take_back(mark, lines_);
    expansion_.calls = calls;
    expansion_.calls_left.resize(left);
    return failed;
  }

  std::string copy_bodies(const Copying& body, long repeats, const SubprogramCall& call, const Block& block) {
    std::string failed;
    stack_.push_back(body.definition);
    for (long i = 0; i < repeats && failed.empty(); ++i) {
      count_call(call, block);
      failed = copy_body(body);
    }
    stack_.pop_back();
    return failed;
  }

  std::string copy_body(const Copying& body) {
    Block block = before(body.definition->body);
    block.called_from = body.called_from;
    while (next_line(text_, block)) {
      lex(text_, file_, dialect_, block);
      if (block.span.begin >= body.definition->end.at) break;
      if (std::string why = copy_block(block, body); !why.empty()) return why;
    }
    copy_last_block(block, body);
    return {};
  }

  /// Words beside M99 are done before it comes back.
  void copy_last_block(const Block& block, const Copying& body) {
    const Word* m99 = find_m(block, 99);
    const auto counts = [&](const Word& word) { return word.letter != 'N' && &word != m99; };
    if (m99 == nullptr || std::none_of(block.words.begin(), block.words.end(), counts)) return;
    note_moves(block);
    lines_.append(line_without(text_, dialect_, block, {m99->span}), block.line, body.called_from);
  }

  void note_moves(const Block& block) {
    moves_ = moves_ || std::any_of(block.words.begin(), block.words.end(),
                                   [](const Word& word) { return word.letter >= 'X' && word.letter <= 'Z'; });
  }

  struct Found {
    const Definition* definition;
    std::string why;
  };

  Found find(const SubprogramCall& call, long& repeats) {
    auto places = definitions_.find(call.name);
    if (places == definitions_.end() && !call.other_reading.name.empty()) {
      repeats = call.other_repeats;
      places = definitions_.find(call.other_reading);
    }
    if (places == definitions_.end()) return {nullptr, "the subprogram does not stand in this file: put it behind the end of the program"};
    if (places->second.size() > 1) return {nullptr, "the subprogram stands in this file more than once"};
    auto known = read_.find(places->first);
    if (known == read_.end())
      known = read_
                  .emplace(places->first,
                           read_definition(text_, file_, dialect_, places->first, places->second[0]))
                  .first;
    const Definition& d = known->second;
    seeks_numbers_ = seeks_numbers_ || d.seeks_numbers;
    if (!d.why_not.empty()) return {nullptr, d.why_not};
    if (!d.ends) return {nullptr, "its body does not end with M99 or endsub"};
    return {&d, {}};
  }

  void refuse_depth(const Definition& d, const SubprogramCall& call, const Block& block) const {
    if (std::find(stack_.begin(), stack_.end(), &d) != stack_.end())
      refuse(file_, block, call.said.begin, "the subprogram calls itself: its expansion has no end");
    if (stack_.size() >= deepest_calls)
      refuse(file_, block, call.said.begin, fmt::format("calls are nested more than {} deep", deepest_calls));
  }

  /// Arguments are worked out with the parameters of the body that the call stands in.
  std::string set_parameters(const SubprogramCall& call, const Copying& caller, Copying& body) const {
    if (call.name.kind != NameKind::word) return {};
    if (reads_results_) return "the program reads what calls give back";
    if (call.arguments.size() > arguments_of_call)
      return fmt::format("it has {} arguments, at most {} are read", call.arguments.size(),
                         arguments_of_call);
    for (const std::string& argument : call.arguments) {
      const auto value = constant_value(argument, caller.parameters);
      if (!value) return fmt::format("its argument [{}] is no plain number", argument);
      body.parameters.push_back(*value);
    }
    body.parameters.resize(arguments_of_call, 0);
    return {};
  }

  void count_call(const SubprogramCall& call, const Block& block) {
    if (expansion_.calls++ == 0) expansion_.first_call = block.line;
    const std::size_t most = largest_expansion(text_.size());
    if (lines_.text.size() > most || expansion_.calls > most_expanded_calls)
      refuse(file_, block, call.said.begin,
             fmt::format("{}: the expanded calls make more than {} bytes, or are more than {}; repeat it less often, "
                         "or leave out --expand-subprograms",
                         part(text_, call.said), most, most_expanded_calls));
  }

  std::string_view text_;
  const std::string& file_;
  const Dialect& dialect_;
  std::string_view why_none_;
  Definitions definitions_;
  std::ptrdiff_t numbered_programs_ = 0;
  ExpandedLines lines_;
  Expansion expansion_{};
  Structures structures_{};
  std::map<SubprogramName, Definition> read_{};
  std::vector<const Definition*> stack_{};  ///< bodies that are being copied
  std::vector<Span> kept_{};                ///< definitions that stand in the program
  bool reads_results_ = false;              ///< #<_value> of LinuxCNC
  bool other_calls_ = false;                ///< a call is left, which may run any definition
  bool seeks_numbers_ = false;
  bool moves_ = false;  ///< there are axis words outside definitions
};

}  // namespace

ExpandedText expand_text(std::string_view text, const std::string& file, const Dialect& dialect,
                         std::string_view why_none) {
  return Expander(text, file, dialect, why_none).run();
}

}  // namespace counterflex
