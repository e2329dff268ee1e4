#include "process/terminal.hpp"

// clang-format off
#include <windows.h>  // comes first
#include <shellapi.h>
// clang-format on

#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <cstdlib>
#include <cwchar>
#include <string>
#include <string_view>

namespace counterflex::cli {
namespace {

/// UTF-8, with / for each backslash.
std::string portable(std::wstring_view text) {
  const int wide = static_cast<int>(text.size());
  const int size = ::WideCharToMultiByte(CP_UTF8, 0, text.data(), wide, nullptr, 0, nullptr, nullptr);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, text.data(), wide, bytes.data(), size, nullptr, nullptr);
  std::ranges::replace(bytes, '\\', '/');
  return bytes;
}

HANDLE handle_of(int descriptor) {
  return reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor));
}

std::vector<const char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<const char*> pointers;
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  return pointers;
}

}  // namespace

/// Arguments and variables of C have the code page of the computer, which lacks most letters.
std::vector<const char*> begin_process(int, char**) {
  for (int stream = 0; stream <= 2; ++stream) ::_setmode(stream, _O_BINARY);
  ::SetConsoleOutputCP(CP_UTF8);
  static std::vector<std::string> arguments;
  int count = 0;
  wchar_t** words = ::CommandLineToArgvW(::GetCommandLineW(), &count);
  for (int i = 0; i < count; ++i) arguments.push_back(portable(words[i]));
  ::LocalFree(words);
  return pointers_to(arguments);
}

const char* const* environment_variables() {
  static const std::vector<std::string> texts = [] {
    std::vector<std::string> found;
    wchar_t* block = ::GetEnvironmentStringsW();
    for (const wchar_t* text = block; *text != L'\0'; text += std::wcslen(text) + 1)
      found.push_back(portable(text));
    ::FreeEnvironmentStringsW(block);
    return found;
  }();
  static const std::vector<const char*> variables = [] {
    std::vector<const char*> pointers = pointers_to(texts);
    pointers.push_back(nullptr);
    return pointers;
  }();
  return variables.data();
}

bool is_terminal(int descriptor) {
  DWORD mode = 0;
  return ::GetConsoleMode(handle_of(descriptor), &mode) != 0;
}

bool has_colours(int descriptor) {
  DWORD mode = 0;
  return ::GetConsoleMode(handle_of(descriptor), &mode) != 0 &&
         ::SetConsoleMode(handle_of(descriptor), mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

bool shows_utf8(int descriptor) {
  return is_terminal(descriptor);
}

bool is_ready(int) {
  return true;
}

std::size_t columns_of(int descriptor) {
  CONSOLE_SCREEN_BUFFER_INFO screen;
  if (::GetConsoleScreenBufferInfo(handle_of(descriptor), &screen) == 0) return 0;
  return static_cast<std::size_t>(screen.srWindow.Right - screen.srWindow.Left + 1);
}

}  // namespace counterflex::cli
