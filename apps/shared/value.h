#pragma once

#include <string>
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

}  // namespace tether::app
