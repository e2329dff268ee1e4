#pragma once
/// Blocks of Heidenhain Klartext and their words, as spans of the text. A line that ends with '~' continues
/// in the next line; both belong to one block.
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/program/program.hpp"

namespace counterflex {

/// "X+10", "IY-2,5", "FMAX", "R0", "DR-", "M3", "Z+Q13".
struct KlartextWord {
  std::string key;           ///< in upper case, without the I of an incremental coordinate
  bool incremental = false;  ///< "IX"
  Span span;
  Span number;  ///< with its sign; of "DR-" the sign; empty without a number
  double value = 0;
  int decimals = 0;
  bool literal = false;  ///< a plain number; else an expression, or no number
};

/// One block. Its vectors are reused from block to block.
struct KlartextBlock {
  int line = 0;       ///< of its first line, from 1
  int last_line = 0;  ///< of its last
  int file_line = 0;  ///< of the file, if calls were expanded; 0: `line`
  Span span;          ///< without the last line end
  Span line_end;
  Span block_delete;           ///< '/'; empty without '/'
  Span number;                 ///< digits of the block's number; empty if it has none
  std::string head;            ///< letters at the begin of the statement, in upper case
  std::vector<Span> parts;     ///< the statement, line by line, without comments and '~'
  std::vector<Span> comments;  ///< text behind ';' or '*', or in a line that begins with '(' or "--"
};

/// Whether `text` is Klartext: its first statement, behind comments, is BEGIN PGM.
bool is_klartext(std::string_view text);

/// Whether the first statement of `text` is Klartext; used for files with the extension ".h".
bool begins_like_klartext(std::string_view text);

/// Moves `block` to the block after `block.line_end`; false at the end of `text`. A default block is before
/// the first block. A blank line is a block without parts.
bool next_klartext_block(std::string_view text, KlartextBlock& block);

/// Whether the block whose line ends at `newline` continues in the next line.
bool continues_behind(std::string_view text, std::size_t newline);

/// The statement's text after its head: on the first line, or the whole of a later one.
std::string_view after_head(std::string_view text, const KlartextBlock& block);

/// LT, LN, CT or LCT behind APPR or DEP; empty if the kind is polar or unknown.
std::string_view approach_kind(std::string_view text, const KlartextBlock& block);

/// The words behind the head of a block that moves the tool, and behind the kind of APPR and DEP, without the
/// limits of M118. False if a word is unknown. Throws `InputError` for a coordinate without a number, for a
/// number that no control reads, and for an axis that occurs twice.
bool lex_klartext_words(std::string_view text, const std::string& file, const KlartextBlock& block,
                        std::vector<KlartextWord>& words);

/// The place of "X+20" behind the head of a block in which the tool does not move; npos without one.
std::size_t find_coordinate(std::string_view text, const KlartextBlock& block);

/// The word with that key, or nullptr.
const KlartextWord* find_word(const std::vector<KlartextWord>& words, std::string_view key);

/// `text` without blanks and in upper case, for comparing statements.
std::string squeezed(std::string_view text);

/// Throws an `InputError` at byte `at`.
[[noreturn]] void refuse_klartext(std::string_view text, const std::string& file, const KlartextBlock& block,
                                  std::size_t at, const std::string& message);

}  // namespace counterflex
