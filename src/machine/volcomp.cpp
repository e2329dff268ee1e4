#include "counterflex/machine/volcomp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "counterflex/geometry/types.hpp"

namespace counterflex {
namespace {

constexpr std::string_view axes = "XYZABC", blanks = " \t\r,;";

bool is_rotary(char axis) {
  return axis >= 'A' && axis <= 'C';
}
bool is_axis(char letter) {
  return axes.find(letter) != std::string_view::npos;
}
/// "EXY": the component X of the axis Y.
bool is_component(std::string_view name) {
  return name.size() == 3 && name[0] == 'E' && is_axis(name[1]) && is_axis(name[2]);
}
/// "C0Y": a constant between two axes.
bool is_position_error(std::string_view name) {
  return name.size() == 3 && is_axis(name[0]) && name[1] == '0' && is_axis(name[2]);
}
double unit_of_error(char component) {
  return is_rotary(component) ? 1 : mm;
}

struct Word {
  std::string_view text;
  int line = 0, column = 0;
};

/// The words of a line without its comment.
std::vector<Word> words_of(std::string_view line, int number) {
  line = line.substr(0, line.find("//"));
  std::vector<Word> words;
  for (std::size_t i = line.find_first_not_of(blanks); i != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, i), line.size());
    words.push_back({line.substr(i, end - i), number, static_cast<int>(i) + 1});
    i = line.find_first_not_of(blanks, end);
  }
  return words;
}

/// One component along its axis: positions (m or rad) with their errors (m or rad).
struct Column {
  std::vector<double> at, error;
};

class VolcompReader {
 public:
  VolcompReader(std::string_view text, std::string file, bool negate)
      : text_(text), file_(std::move(file)), sign_(negate ? -1 : 1) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
  }

  Volcomp isg() {
    std::vector<Word> header;
    for (std::vector<Word> words; next(words);) {
      if (words.front().text.starts_with('#'))
        header.clear();
      else if (header.empty())
        header = checked_header(words);
      else
        take_row(header, words);
    }
    return finished();
  }

  Volcomp etalon() {
    std::optional<Word> name;
    bool in_grid = false;
    for (std::vector<Word> words; next(words);) {
      const Word& first = words.front();
      if (in_grid) {
        in_grid = first.text != "}";
        if (in_grid) take_point(*name, words);
      } else if (first.text.size() > 2 && first.text.front() == '[' && first.text.back() == ']') {
        name = Word{first.text.substr(1, first.text.size() - 2), first.line, first.column + 1};
        if (!is_component(name->text) && !is_position_error(name->text)) fail_name(*name);
      } else if (name && first.text == "VALUE" && words.size() == 3 && words[1].text == "=") {
        take_constant(*name, words[2]);
      } else if (name && first.text == "Gridpoints" && words.back().text == "{") {
        if (!is_component(name->text))
          fail(*name, fmt::format("{} has a table; it must have a VALUE", name->text));
        in_grid = true;
      } else {
        fail(first,
             fmt::format("\"{}\" is not expected here; a block is [EXX] with Gridpoints = {{ or VALUE =",
                         first.text));
      }
    }
    if (in_grid)
      fail({name->text, name->line, name->column}, fmt::format("{} has no }} behind its table", name->text));
    return finished();
  }

 private:
  [[noreturn]] void fail(const Word& at, const std::string& what) const {
    throw InputError(ErrorKind::machine_or_force, {file_, at.line, at.column}, what);
  }
  [[noreturn]] void fail_name(const Word& at) const {
    fail(at, fmt::format("\"{}\" is not the name of an error: EXX to ECC, or A0Y and others", at.text));
  }

  /// The words of the next line that has any.
  bool next(std::vector<Word>& words) {
    for (words.clear(); words.empty() && !text_.empty();) {
      const std::size_t end = text_.find('\n');
      words = words_of(text_.substr(0, end), ++line_);
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    }
    return !words.empty();
  }

  double number(const Word& word) const {
    double value = 0;
    const char* const end = word.text.data() + word.text.size();
    const auto [stop, error] = std::from_chars(word.text.data(), end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value))
      fail(word, fmt::format("\"{}\" is not a number; decimals have a point", word.text));
    return value;
  }

  std::vector<Word> checked_header(std::vector<Word> header) const {
    int arguments = 0;
    for (const Word& word : header) {
      const bool is_argument = word.text.size() == 1 && is_axis(word.text[0]);
      if (!is_argument && !is_component(word.text) && !is_position_error(word.text)) fail_name(word);
      if (is_argument && ++arguments > 1)
        fail(word, fmt::format("the errors depend on {} and {}; tables of one position are read",
                               header[0].text, word.text));
    }
    for (const Word& word : header)
      if (is_component(word.text) && (header[0].text.size() != 1 || header[0].text[0] != word.text[2]))
        fail(word, fmt::format("{} needs positions of {} in the first column", word.text, word.text[2]));
    return header;
  }

  void take_row(const std::vector<Word>& header, const std::vector<Word>& row) {
    if (row.size() != header.size())
      fail(row.front(),
           fmt::format("the line has {} numbers, but the header names {}", row.size(), header.size()));
    for (std::size_t i = 0; i < row.size(); ++i)
      if (is_component(header[i].text))
        add(header[i].text, row[0], row[i]);
      else if (header[i].text.size() > 1)
        take_constant(header[i], row[i]);
      else
        number(row[i]);
  }

  void take_point(const Word& name, const std::vector<Word>& words) {
    if (words.size() != 2)
      fail(words.front(),
           fmt::format("a line of the table has {} numbers; it has a position and an error", words.size()));
    add(name.text, words[0], words[1]);
  }

  void add(std::string_view name, const Word& position, const Word& error) {
    Column& column = columns_[std::string(name)];
    const double at = number(position) * (is_rotary(name[2]) ? deg : mm);
    if (!column.at.empty() && !(at > column.at.back()))
      fail(position, fmt::format("position {} of {} is not above the one before it; positions must increase",
                                 position.text, name));
    column.at.push_back(at);
    column.error.push_back(sign_ * number(error) * unit_of_error(name[1]));
  }

  void take_constant(const Word& name, const Word& value) {
    if (!is_position_error(name.text))
      fail(name, fmt::format("{} has a VALUE; it must have a table", name.text));
    const auto [first, is_new] = constants_.emplace(name.text, value);
    if (!is_new && number(value) != number(first->second))
      fail(value, fmt::format("{} is {}, but {} in line {}; a constant has one value: remove the wrong one",
                              name.text, value.text, first->second.text, first->second.line));
    result_.position_errors[first->first] = sign_ * number(value) * unit_of_error(name.text[0]);
  }

  Volcomp finished() {
    for (const auto& [name, column] : columns_) {
      if (column.at.size() < 2)
        throw InputError(ErrorKind::machine_or_force, {file_},
                         fmt::format("{} has 1 position; a table needs 2", name));
      std::vector<double>& all = result_.tables[name[2]].positions;
      all.insert(all.end(), column.at.begin(), column.at.end());
    }
    for (auto& [axis, table] : result_.tables) {
      table.name = fmt::format("{}", static_cast<char>(axis - 'A' + 'a'));
      std::ranges::sort(table.positions);
      table.positions.erase(std::unique(table.positions.begin(), table.positions.end()),
                            table.positions.end());
      table.errors.assign(table.positions.size(), Vector6::Zero());
    }
    for (const auto& [name, column] : columns_) fill(column, axes.find(name[1]), result_.tables[name[2]]);
    if (columns_.empty() && result_.position_errors.empty())
      throw InputError(ErrorKind::machine_or_force, {file_}, "the file has no errors; is it of this format?");
    return std::move(result_);
  }

  /// Linear between the positions of the column, constant outside.
  static void fill(const Column& column, std::size_t component, ErrorTable& table) {
    for (std::size_t k = 0; k < table.positions.size(); ++k) {
      const double at = std::clamp(table.positions[k], column.at.front(), column.at.back());
      const auto above = std::lower_bound(column.at.begin() + 1, column.at.end() - 1, at);
      const auto i = static_cast<std::size_t>(above - column.at.begin());
      const double share = (at - column.at[i - 1]) / (column.at[i] - column.at[i - 1]);
      table.errors[k][static_cast<Eigen::Index>(component)] =
          at == column.at[i] ? column.error[i] : (1 - share) * column.error[i - 1] + share * column.error[i];
    }
  }

  std::string_view text_;
  const std::string file_;
  const double sign_;
  int line_ = 0;
  std::map<std::string, Column> columns_;
  std::map<std::string, Word> constants_;  ///< where each was first
  Volcomp result_;
};

}  // namespace

Volcomp read_volcomp(std::string_view text, const std::string& file, VolcompFormat format, bool negate) {
  VolcompReader reader(text, file, negate);
  return format == VolcompFormat::isg ? reader.isg() : reader.etalon();
}

std::string table_text(char axis, const ErrorTable& table) {
  const auto list = [](const std::vector<double>& values) {
    return fmt::format("[{:.9g}]", fmt::join(values, ", "));
  };
  std::string text = fmt::format("[error_tables.{}]\n", table.name);
  std::vector<double> values;
  for (const double at : table.positions) values.push_back(at / (is_rotary(axis) ? deg : mm));
  text += fmt::format("positions_{} = {}\n", is_rotary(axis) ? "deg" : "mm", list(values));
  for (Eigen::Index i = 0; i < 6; ++i) {
    values.clear();
    for (const Vector6& error : table.errors) values.push_back(error[i] / um);
    if (std::ranges::all_of(values, [](double v) { return v == 0; })) continue;
    text += fmt::format("E{}{}_{} = {}\n", axes[static_cast<std::size_t>(i)], axis, i < 3 ? "um" : "urad",
                        list(values));
  }
  return text;
}

}  // namespace counterflex
