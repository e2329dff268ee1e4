/// Reads one JSON document from standard input, and nothing after it, and prints the value at a JSON pointer.
///   json_value /summary/after/max_mm
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

int main(int argc, char** argv) try {
  const auto document = nlohmann::json::parse(std::cin);
  std::cout << document.at(nlohmann::json::json_pointer(argc > 1 ? argv[1] : "")) << '\n';
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
