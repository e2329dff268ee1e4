#include "toml/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "toml/suggest.hpp"

namespace counterflex::toml_file {
namespace {

template <int N>
Eigen::Matrix<double, N, 1> as_vector(const toml::node& node, const Label& label, const Reading& reading) {
  const toml::array* array = node.as_array();
  if (array == nullptr || array->size() != N)
    reading.source.fail(node, fmt::format("{} must be {} numbers, not {}", label.text(), N, seen(node)));
  Eigen::Matrix<double, N, 1> v;
  for (std::size_t k = 0; k < N; ++k) {
    const Label entry = label.i == 0 ? Label{label.name, k + 1} : Label{label.name, label.i, k + 1};
    v[static_cast<int>(k)] = as_number((*array)[k], entry, reading);
  }
  return v;
}

double value_of(const std::string& reference, const toml::node& node, const Reading& reading) {
  if (reading.fillings == nullptr)
    reading.source.fail(
        node, fmt::format("\"{}\" is outside templates and branches, so it has no value", reference));
  Fillings& fillings = *reading.fillings;
  const auto found = fillings.values.find(std::string_view(reference).substr(1));
  if (found == fillings.values.end())
    reading.source.fail(*fillings.place,
                        fmt::format("chain \"{}\" lacks values.{}, which its elements use in line {}",
                                    fillings.chain, reference.substr(1), node.source().begin.line));
  found->second.used = true;
  return found->second.value;
}

}  // namespace

std::string Label::text() const {
  if (i == 0) return std::string(name);
  return j == 0 ? fmt::format("{}[{}]", name, i) : fmt::format("{}[{}][{}]", name, i, j);
}

std::string seen(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("the string \"{}\"", text->get());
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* array = node.as_array())
    return array->empty() ? "an empty array" : fmt::format("an array of {}", array->size());
  return node.is_table() ? "a table" : "a date or time";
}

std::string filled_by(const toml::node& node, const Reading& reading) {
  const toml::array* array = node.as_array();
  const bool filled = array == nullptr
                          ? node.is_string()
                          : std::any_of(array->begin(), array->end(),
                                        [](const toml::node& entry) { return entry.is_string(); });
  return filled && reading.fillings != nullptr
             ? fmt::format(", the value of chain \"{}\"", reading.fillings->chain)
             : "";
}

void check_keys(const toml::table& table, const std::vector<std::string_view>& allowed,
                std::string_view owner, const Source& source) {
  const toml::key* unknown = nullptr;
  for (const auto& [key, value] : table) {
    if (std::find(allowed.begin(), allowed.end(), key.str()) != allowed.end()) continue;
    if (unknown == nullptr || before(key.source(), unknown->source())) unknown = &key;
  }
  if (unknown == nullptr) return;
  source.fail(*unknown, fmt::format("unknown key \"{}\" in {}{}", unknown->str(), owner,
                                    hint(unknown->str(), allowed, "allowed")));
}

const toml::node& required(const toml::table& table, std::string_view key, std::string_view owner,
                           const toml::node& owner_node, const Source& source) {
  const toml::node* node = table.get(key);
  if (node == nullptr) source.fail(owner_node, fmt::format("{} has no \"{}\"", owner, key));
  return *node;
}

const toml::table& as_table(const toml::node& node, std::string_view name, const Source& source) {
  if (!node.is_table()) source.fail(node, fmt::format("{} must be a table, not {}", name, seen(node)));
  return *node.as_table();
}

const toml::array& as_array(const toml::node& node, std::string_view name, const Source& source) {
  if (!node.is_array()) source.fail(node, fmt::format("{} must be an array, not {}", name, seen(node)));
  return *node.as_array();
}

std::string as_text(const toml::node& node, std::string_view name, const Source& source) {
  const auto* text = node.as_string();
  if (text == nullptr) source.fail(node, fmt::format("{} must be a string, not {}", name, seen(node)));
  if (text->get().empty()) source.fail(node, fmt::format("{} is an empty string", name));
  return text->get();
}

std::string as_identifier(const toml::node& node, std::string_view name, const Source& source) {
  std::string text = as_text(node, name, source);
  const bool fits = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return (std::isalnum(c) != 0 && c < 128) || c == '_' || c == '-';
  });
  if (!fits) source.fail(node, fmt::format("{} is \"{}\"; allowed are letters, digits, _ and -", name, text));
  return text;
}

bool as_truth(const toml::node& node, std::string_view name, const Source& source) {
  const auto* truth = node.as_boolean();
  if (truth == nullptr) source.fail(node, fmt::format("{} must be true or false, not {}", name, seen(node)));
  return truth->get();
}

std::string as_choice(const toml::node& node, std::string_view name,
                      const std::vector<std::string_view>& allowed, const Source& source) {
  std::string text = as_text(node, name, source);
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end())
    source.fail(node, fmt::format("{} is \"{}\"{}", name, text, hint(text, allowed, "allowed")));
  return text;
}

double as_number(const toml::node& node, const Label& label, const Reading& reading) {
  if (const auto* number = node.as_integer()) return static_cast<double>(number->get());
  if (const auto* number = node.as_floating_point(); number != nullptr && std::isfinite(number->get()))
    return number->get();
  if (const auto* text = node.as_string();
      text != nullptr && text->get().size() > 1 && text->get().starts_with('$'))
    return value_of(text->get(), node, reading);
  reading.source.fail(node, fmt::format("{} must be a finite number, not {}", label.text(), seen(node)));
}

double as_positive(const toml::node& node, const Label& label, const Reading& reading) {
  const double value = as_number(node, label, reading);
  if (!(value > 0))
    reading.source.fail(
        node, fmt::format("{} is {}{}; it must be positive", label.text(), value, filled_by(node, reading)));
  return value;
}

double as_not_negative(const toml::node& node, const Label& label, const Reading& reading) {
  const double value = as_number(node, label, reading);
  if (!(value >= 0))
    reading.source.fail(node, fmt::format("{} is {}{}; it must not be negative", label.text(), value,
                                          filled_by(node, reading)));
  return value;
}

double as_between(const toml::node& node, const Label& label, double least, double most,
                  const Source& source) {
  const double value = as_number(node, label, {source});
  if (value < least || value > most)
    source.fail(node, fmt::format("{} is {}; it must be from {} to {}", label.text(), value, least, most));
  return value;
}

long as_whole(const toml::node& node, const Label& label, long least, long most, const Source& source) {
  const double value = as_number(node, label, {source});
  if (value != std::floor(value) || value < static_cast<double>(least) || value > static_cast<double>(most))
    source.fail(node, fmt::format("{} is {}; it must be a whole number from {} to {}", label.text(),
                                  seen(node), least, most));
  return std::lround(value);
}

Vector3 as_vector3(const toml::node& node, std::string_view name, const Reading& reading) {
  return as_vector<3>(node, {name}, reading);
}

Eigen::Vector4d as_vector4(const toml::node& node, std::string_view name, const Reading& reading) {
  return as_vector<4>(node, {name}, reading);
}

Vector6 as_vector6(const toml::node& node, std::string_view name, const Reading& reading) {
  return as_vector<6>(node, {name}, reading);
}

Matrix6 as_matrix6(const toml::node& node, std::string_view name, const Reading& reading) {
  const toml::array* rows = node.as_array();
  if (rows == nullptr || rows->size() != 6)
    reading.source.fail(node, fmt::format("{} must be 6 rows of 6 numbers, not {}", name, seen(node)));
  Matrix6 matrix;
  for (std::size_t i = 0; i < 6; ++i)
    matrix.row(static_cast<int>(i)) = as_vector<6>((*rows)[i], {name, i + 1}, reading).transpose();
  return matrix;
}

std::string_view one_of(const toml::table& table, const std::vector<std::string_view>& keys,
                        std::string_view owner, const Source& source) {
  std::string_view first;
  for (const std::string_view key : keys) {
    if (!table.contains(key)) continue;
    if (first.empty()) {
      first = key;
      continue;
    }
    const bool in_order = before(key_of(table, first).source(), key_of(table, key).source());
    const std::string_view second = in_order ? key : first;
    source.fail(key_of(table, second), fmt::format("{} has both \"{}\" and \"{}\"; give one of {}", owner,
                                                   in_order ? first : key, second, fmt::join(keys, ", ")));
  }
  return first;
}

void check_preload_home(const toml::node& preload, const std::string& instead, const Source& source) {
  const auto* text = preload.as_string();
  if (text != nullptr && text->get() == "home") return;
  source.fail(preload, fmt::format("preload must be \"home\"{}, not {}", instead, seen(preload)));
}

}  // namespace counterflex::toml_file
