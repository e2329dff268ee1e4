#include "report/text/sanity_text.hpp"

#include "counterflex/report/formats.hpp"

namespace counterflex {
namespace {

std::string mark(SanityState state, const Ink& ink) {
  switch (state) {
    case SanityState::ok:
      return ink.good(ink.marks ? "\u2713" : "[ok]");
    case SanityState::unknown:
      return ink.marks ? "?" : "[??]";
    case SanityState::doubtful:
      return ink.warning(ink.marks ? "\u2717" : "[!!]");
    case SanityState::wrong:
      return ink.bad(ink.marks ? "\u2717" : "[!!]");
  }
  return "";
}

// The mark has more bytes than columns: UTF-8 and ANSI sequences.
std::string line(SanityState state, const std::string& text, const Ink& ink) {
  const std::string plain = ink.marks ? "  x " : "  [xx] ";
  const std::string wrapped_text = wrapped(plain, text, plain.size());
  return "  " + mark(state, ink) + " " + wrapped_text.substr(plain.size());
}

}  // namespace

std::string sanity_text(const SanityChecks& checks, const Ink& ink) {
  if (checks.empty()) return "";
  std::string text = line_break() + ink.bold("Checks") + "\n";
  for (const SanityCheck& check : checks) text += line(check.state, check.name + ": " + check.text, ink);
  return text;
}

std::string sanity_block(const SanityChecks& checks, bool colour, bool marks) {
  return sanity_text(checks, {colour, marks});
}

}  // namespace counterflex
