#include "import/linuxcnc/configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "counterflex/files/csv_text.hpp"
#include "counterflex/files/text.hpp"
#include "import/toml_text.hpp"

namespace counterflex::import {
namespace {

constexpr double no_limit = 1e9;  // LinuxCNC's default is 1e99

struct Word {
  std::string_view text;
  int column = 1;
};

std::vector<Word> words_of(std::string_view line) {
  std::vector<Word> words;
  constexpr std::string_view blanks = " \t\r";
  for (std::size_t begin = line.find_first_not_of(blanks); begin != line.npos;) {
    const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    if (line[begin] == '#') break;
    words.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

/// "[KINS]A0" or "[KINS](A0)" replaced by its value; other text as it is.
std::string substituted(const Word& word, const Location& at, const IniValues* ini) {
  if (!word.text.starts_with('[')) return std::string(word.text);
  const std::size_t close = word.text.find(']');
  if (close == word.text.npos) return std::string(word.text);
  const std::string section(word.text.substr(1, close - 1));
  std::string key(word.text.substr(close + 1));
  if (key.starts_with('(') && key.ends_with(')')) key = key.substr(1, key.size() - 2);
  if (ini == nullptr)
    fail(at, fmt::format("{} is a value of the INI file; import the INI file instead of this HAL file",
                         without_controls(word.text)));
  const PlacedText* value = ini->find(section, key);
  if (value == nullptr)
    fail(at, fmt::format("{} has no {}, which this line needs", ini->file, without_controls(word.text)));
  return value->text;
}

bool is_of_kinematics(std::string_view pin) {
  return pin.starts_with("genserkins.") || pin.starts_with("genhexkins.");
}

void add_pin(HalPins& pins, std::string_view name, HalPin pin) {
  const auto [entry, is_new] = pins.emplace(name, pin);
  if (!is_new)
    fail(pin.at, fmt::format("the pin {} is set a second time; the first is {}:{}", without_controls(name),
                             entry->second.at.file, entry->second.at.line));
}

void read_hal(const ConfigurationFile& file, const IniValues* ini, HalPins& pins) {
  std::string_view text = file.text;
  for (int line = 1; !text.empty(); ++line) {
    const std::vector<Word> words = words_of(csv::take_line(text));
    if (words.size() < 2) continue;
    const auto at = [&](const Word& word) { return Location{file.name, line, word.column}; };
    if (words[0].text == "setp" && is_of_kinematics(words[1].text)) {
      if (words.size() != 3)
        fail(at(words[1]), fmt::format("setp {} needs one value", without_controls(words[1].text)));
      add_pin(pins, words[1].text, {substituted(words[2], at(words[2]), ini), at(words[2])});
    }
    if (words[0].text != "net") continue;
    for (std::size_t i = 2; i < words.size(); ++i)
      if (is_of_kinematics(words[i].text)) add_pin(pins, words[i].text, {"", at(words[i])});
  }
}

}  // namespace

const PlacedText* IniValues::find(const std::string& section, const std::string& key) const {
  const auto found = sections.find(section);
  if (found == sections.end()) return nullptr;
  const auto values = found->second.find(key);
  return values == found->second.end() ? nullptr : &values->second.front();
}

std::optional<double> IniValues::number(const std::string& section, const std::string& key) const {
  const PlacedText* value = find(section, key);
  if (value == nullptr) return std::nullopt;
  const std::string_view first = std::string_view(value->text).substr(0, value->text.find_first_of(" \t"));
  const auto result = read_number(first);
  if (!result)
    fail(value->at, fmt::format("[{}] {} is '{}'; it must be a finite number", section, key,
                                without_controls(value->text)));
  return result;
}

IniValues read_ini(const ConfigurationFile& ini) {
  IniValues values{ini.name, {}};
  std::string_view text = ini.text;
  std::string section;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view whole = csv::take_line(text), content = csv::trimmed(whole);
    if (content.starts_with("#INCLUDE"))
      fail({ini.name, line, 1}, "#INCLUDE is not followed; put the lines of that file here");
    if (content.empty() || content.starts_with('#') || content.starts_with(';')) continue;
    const int column = static_cast<int>(content.data() - whole.data()) + 1;
    if (content.starts_with('[')) {
      const std::size_t close = content.find(']');
      if (close == content.npos) fail({ini.name, line, column}, "the name of the section has no ]");
      section = content.substr(1, close - 1);
      continue;
    }
    const std::size_t equals = content.find('=');
    if (equals == content.npos) continue;  // LinuxCNC ignores such lines
    const std::string_view value = csv::trimmed(content.substr(equals + 1));
    const int value_column = value.empty() ? column : static_cast<int>(value.data() - whole.data()) + 1;
    values.sections[section][std::string(csv::trimmed(content.substr(0, equals)))].push_back(
        {std::string(value), {ini.name, line, value_column}});
  }
  return values;
}

HalPins read_pins(const std::vector<ConfigurationFile>& files, const IniValues* ini) {
  HalPins pins;
  for (const ConfigurationFile& file : files)
    if (!file.name.ends_with(".ini")) read_hal(file, ini, pins);
  return pins;
}

double pin_value(const HalPins& pins, const std::string& name, const std::string& file) {
  const auto found = pins.find(name);
  if (found == pins.end())
    fail({file, 1, 1},
         fmt::format(
             "no line sets the pin {}; its default depends on the version of LinuxCNC. Add: setp {} VALUE",
             name, name));
  const HalPin& pin = found->second;
  if (pin.value.empty())
    fail(pin.at,
         fmt::format("the pin {} is connected with a signal, so its value is not known; use setp", name));
  return read_usable(pin.value, pin.at, name);
}

void refuse_unknown_pins(const HalPins& pins, const std::vector<std::string>& known) {
  for (const auto& [name, pin] : pins) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string_view meant = nearest(name, {known.begin(), known.end()});
    fail(pin.at, fmt::format("unknown pin {}{}", without_controls(name),
                             meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
  }
}

Travel travel_of_joint(const IniValues* ini, std::size_t joint, double unit) {
  Travel travel;
  if (ini == nullptr) return travel;
  const std::string section = fmt::format("JOINT_{}", joint);
  const auto limit = [&](const char* key) -> std::optional<double> {
    const auto value = ini->number(section, key);
    if (!value || std::abs(*value) > no_limit) return std::nullopt;
    return *value * unit;
  };
  travel.min = limit("MIN_LIMIT");
  travel.max = limit("MAX_LIMIT");
  if (travel.min && travel.max && !(*travel.min + 1e-9 < *travel.max))
    fail(ini->find(section, "MAX_LIMIT")->at,
         fmt::format("MAX_LIMIT of [{}] is not above its MIN_LIMIT", section));
  return travel;
}

}  // namespace counterflex::import
