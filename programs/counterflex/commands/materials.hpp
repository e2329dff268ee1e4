#pragma once
/// The coefficients that cutting models can name.
#include <string>

namespace counterflex::cli {

/// A page for people, or a document for programs.
std::string materials_page(bool json);

}  // namespace counterflex::cli
