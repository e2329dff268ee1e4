#include "program/expand/subprograms.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "program/expand/expand.hpp"

namespace counterflex {
namespace {

constexpr std::size_t arguments_of_call = 30;

}  // namespace

Subprograms::Subprograms(std::string_view text, const std::string& file, const Dialect& dialect)
    : text_(text),
      file_(file),
      dialect_(dialect),
      places_(may_expand(dialect) ? find_definitions(text, file, dialect) : Definitions{}) {}

std::ptrdiff_t Subprograms::numbered() const {
  return std::count_if(places_.begin(), places_.end(),
                       [](const auto& named) { return named.first.kind == NameKind::program; });
}

Subprograms::Found Subprograms::find(const SubprogramCall& call) {
  long repeats = call.repeats;
  auto places = places_.find(call.name);
  if (places == places_.end() && !call.other_reading.name.empty()) {
    repeats = call.other_repeats;
    places = places_.find(call.other_reading);
  }
  if (places == places_.end())
    return {.why = "the subprogram is not in this file: append it behind the end of the program"};
  if (places->second.size() > 1) return {.why = "this file defines the subprogram more than once"};
  auto known = read_.find(places->first);
  if (known == read_.end())
    known =
        read_
            .emplace(places->first, read_definition(text_, file_, dialect_, places->first, places->second[0]))
            .first;
  const Definition& d = known->second;
  if (!d.why_not.empty()) return {.why = d.why_not, .seeks_numbers = d.seeks_numbers};
  if (!d.ends) return {.why = "its body does not end with M99 or endsub", .seeks_numbers = d.seeks_numbers};
  return {.definition = &d, .repeats = repeats, .seeks_numbers = d.seeks_numbers};
}

std::string evaluate_arguments(const SubprogramCall& call, const Dialect& dialect, const Variables& variables,
                               std::vector<double>& arguments) {
  if (call.arguments.size() > arguments_of_call)
    return fmt::format("it has {} arguments, at most {} are allowed", call.arguments.size(),
                       arguments_of_call);
  for (const std::string& argument : call.arguments) {
    const auto value = value_of_expression(argument, dialect, variables).value;
    if (!value) return fmt::format("its argument [{}] is not a plain number", argument);
    arguments.push_back(*value);
  }
  arguments.resize(arguments_of_call, 0);
  return {};
}

}  // namespace counterflex
