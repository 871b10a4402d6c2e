#pragma once

#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace tether::app {

/// What an option's value may be, as far as its definition says.
struct Value {
  std::string word;                    ///< for the help: "TEXT", "NUMBER", "text|html"
  std::string range{};                 ///< of a number: "0 to 10"; empty: any
  bool is_whole = false;               ///< of a number
  std::vector<std::string> choices{};  ///< empty: not a choice
};
Value value_of(const CLI::Option& option);

/// "Folder [out]": "Folder" and "out".
std::pair<std::string, std::string> split_default(const std::string& text);

/// What an option is for, the range of its number, and its default in brackets at the end.
std::string text_of(const CLI::Option& option);

bool takes_value(const CLI::Option& option);
bool is_list(const CLI::Option& option);

/// In the order in which they were added.
std::vector<const CLI::App*> subcommands_of(const CLI::App& command);

}  // namespace tether::app
