#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// The options of a program as data, of which its parser, help, completion and manual page are
/// made. This header does without CLI11, which is expensive to compile.
namespace tether::app {

/// JSON and numbers of other programs have whole numbers up to this one.
inline constexpr double kLargestWhole = 9007199254740992.0;

/// Where a value goes, which must be there until the command line has been parsed. A function can
/// throw std::invalid_argument with what is wrong with the value.
using Destination = std::variant<
    bool*, int*, std::uint64_t*, double*, std::string*, std::filesystem::path*, std::optional<int>*,
    std::optional<double>*, std::optional<std::string>*, std::optional<std::vector<double>>*,
    std::vector<std::string>*, std::vector<std::filesystem::path>*, std::function<void(double)>,
    std::function<void(const std::string&)>, std::function<void(const std::vector<double>&)>>;

/// What a value may be.
struct Allowed {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::vector<std::string> words{};  ///< one of these; empty: any
  /// Returns what is wrong with a value; empty: nothing.
  std::function<std::string(const std::string&)> check{};
  bool is_required = false;
  bool is_one_each = false;  ///< a list gets one value from each time that the option is given
  bool has_commas = false;   ///< between the values of a list
  int count = 0;             ///< of values in a list; 0: any
  std::string usual{};       ///< default, where the destination does not have it
  /// Of an argument that is a list: it gets the words after "--", and only these.
  bool follows_dashes = false;
};
Allowed range(double least, double most);
Allowed one_of(std::vector<std::string> words);
Allowed required();
Allowed checked(std::function<std::string(const std::string&)> check);

/// One option or argument of a command.
struct Option {
  /// "--seed"; with the name of its value, "--out FOLDER"; of an argument, "scenario"; of both,
  /// "file,--file FILE". Without a name of its value, that is named by its type, and a bool is a
  /// flag.
  std::string words;
  std::string help;  ///< without a full stop; a default that is no value at the end: "[its name]"
  Destination destination;
  Allowed allowed{};
};
using Options = std::vector<Option>;

/// "--out" of "--out FOLDER".
std::string key_of(const Option& option);

/// One after the other.
Options concatenated(std::vector<Options> groups);

}  // namespace tether::app
