#pragma once
/// Reads typed values from TOML nodes. Every failure is an `InputError` at the value's place with the value
/// and what is allowed.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "counterflex/geometry/pose.hpp"
#include "toml/source.hpp"

namespace counterflex::toml_file {

/// A named definition of the file, for use in other places.
template <class T>
struct Definition {
  T value{};
  const toml::key* key = nullptr;  ///< where it is defined
  bool used = false;
};

template <class T>
using DefinitionsByName = std::map<std::string, Definition<T>, std::less<>>;

/// The values of a chain for its template. `place` is the place for messages about missing entries.
struct Fillings {
  std::string chain;
  const toml::node* place = nullptr;
  DefinitionsByName<double> values;
  DefinitionsByName<Pose> transforms;
  DefinitionsByName<Pose> errors;
};

/// Context of a node: the file, and the values of "$name" (null outside templates and branches).
struct Reading {
  const Source& source;
  Fillings* fillings = nullptr;
};

/// The name of a number in messages: `name`, `name[i]` or `name[i][j]`, counted from 1.
struct Label {
  std::string_view name;
  std::size_t i = 0;
  std::size_t j = 0;
  std::string text() const;
};

/// The value in words: `the string "x"`, `an array of 3`, `12.5`.
std::string seen(const toml::node& node);

/// `, the value of chain "..."` for a value with a "$name", else empty.
std::string filled_by(const toml::node& node, const Reading& reading);

/// Throws at the first key, in the order of the file, that is not `allowed`; `owner` is the name of the
/// table.
void check_keys(const toml::table& table, const std::vector<std::string_view>& allowed,
                std::string_view owner, const Source& source);

/// The node under `key`. Throws at `owner_node` if it is missing.
const toml::node& required(const toml::table& table, std::string_view key, std::string_view owner,
                           const toml::node& owner_node, const Source& source);

const toml::table& as_table(const toml::node& node, std::string_view name, const Source& source);
const toml::array& as_array(const toml::node& node, std::string_view name, const Source& source);
std::string as_text(const toml::node& node, std::string_view name, const Source& source);
/// A text of letters, digits, "_" and "-".
std::string as_identifier(const toml::node& node, std::string_view name, const Source& source);
bool as_truth(const toml::node& node, std::string_view name, const Source& source);

/// The text of `node`, which must be one of `allowed`.
std::string as_choice(const toml::node& node, std::string_view name,
                      const std::vector<std::string_view>& allowed, const Source& source);

/// A finite number, or "$name" if the context has values.
double as_number(const toml::node& node, const Label& label, const Reading& reading);
double as_positive(const toml::node& node, const Label& label, const Reading& reading);
double as_not_negative(const toml::node& node, const Label& label, const Reading& reading);

/// A number, or a whole number, from `least` to `most`.
double as_between(const toml::node& node, const Label& label, double least, double most,
                  const Source& source);
long as_whole(const toml::node& node, const Label& label, long least, long most, const Source& source);

Vector3 as_vector3(const toml::node& node, std::string_view name, const Reading& reading);
Eigen::Vector4d as_vector4(const toml::node& node, std::string_view name, const Reading& reading);
Vector6 as_vector6(const toml::node& node, std::string_view name, const Reading& reading);
Matrix6 as_matrix6(const toml::node& node, std::string_view name, const Reading& reading);

/// The only key of `keys` in `table`, or empty. Throws at the second of two.
std::string_view one_of(const toml::table& table, const std::vector<std::string_view>& keys,
                        std::string_view owner, const Source& source);

/// Throws unless `preload` is "home"; `instead` adds the alternatives to the message.
void check_preload_home(const toml::node& preload, const std::string& instead, const Source& source);

}  // namespace counterflex::toml_file
