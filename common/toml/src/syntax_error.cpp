#include "syntax_error.h"

#include <algorithm>
#include <regex>
#include <vector>

namespace tether::toml {
namespace {

/// A mistake: how the library and the line show it, and the message, in which $1, $2 are parts of
/// the line.
struct Mistake {
  std::regex parser;
  std::regex line;
  std::string message;
};

const std::vector<Mistake>& mistakes() {
  const auto any = std::regex("[^]*");
  static const std::vector<Mistake> all = {
      {std::regex("utf-8"), any,
       "a character on this line is not UTF-8, as in a Latin-1 file. Save the file as UTF-8"},
      // Strings.
      {std::regex("escape sequence"), any,
       "a '\\' in a string begins an escape, and this one does not exist. Write '\\\\' for each "
       "backslash, or put the string in single quotes"},
      {std::regex("control characters"), std::regex("[^]*[\\x01-\\x08\\x0b-\\x1f][^]*"),
       "the line has a control character. Remove it"},
      {std::regex("string: (encountered end-of-file|.*control characters)"), any,
       "the string is not closed. Add the missing quote at its end"},
      {std::regex("determine value type"), std::regex("[^=]*=\\s*(?:\xe2\x80[\x98-\x9f])[^]*"),
       "the quotes are typographic ones. Use straight quotes: \"…\""},
      // Twice.
      {std::regex("existing array '.*as table"), std::regex("\\s*\\[\\s*([^\\[\\]]+)\\][^]*"),
       "[$1] is also a list of tables. Write [[$1]]"},
      {std::regex("table header: cannot redefine"), std::regex("\\s*\\[\\s*([^\\[\\]]+)\\][^]*"),
       "there are two tables [$1]. Put the keys into one; if it may be there several times, write "
       "[[$1]] each time"},
      {std::regex("cannot redefine"), std::regex("\\s*([^=\\s]+)\\s*=[^]*"),
       "the key '$1' is there twice. Remove one of them"},
      // Booleans and words.
      {std::regex("boolean|determine value type"),
       std::regex("[^=]*=\\s*(yes|no|on|off|true|false)\\s*(#[^]*)?", std::regex::icase),
       "'$1' is not a value. Write true or false, in lower case"},
      {std::regex("boolean|determine value type"),
       std::regex("[^=]*=\\s*([^\\s#]([^#]*[^\\s#])?)\\s*(#[^]*)?"),
       "'$1' is neither a number, a boolean nor a string. Write a string in quotes: \"$1\""},
      // Numbers.
      {std::regex("not representable"), any,
       "the number is too large. The largest whole number is 9223372036854775807"},
      {std::regex("could not be interpreted"), any,
       "the number is too large. The largest is about 1.8e308"},
      {std::regex("leading zeroes"), any, "a number must not begin with 0. Remove the zero"},
      {any, std::regex("[^=]*=\\s*([-+]?\\d+),(\\d+)\\s*(#[^]*)?"),
       "'$1,$2' has a decimal comma. Write $1.$2"},
      {any, std::regex("[^=]*=\\s*([-+]?)\\.(\\d+)\\s*(#[^]*)?"),
       "'$1.$2' needs a digit before the point. Write $010.$2"},
      {any, std::regex("[^=]*=\\s*([-+]?\\d+)\\.\\s*(#[^]*)?"),
       "'$1.' needs a digit after the point. Write $1.0"},
      {any,
       std::regex("[^=]*=\\s*([-+]?\\d+(?:\\.\\d+)?)\\s*([^\\d\\s.,#=\\]}/_:-][^\\s#=\"]*)"
                  "\\s*(#[^]*)?"),
       "'$1' is followed by '$2'. Write the number alone; its unit is that of the key's name"},
      // Keys and headers.
      {std::regex("table header"), std::regex("\\s*(\\[[^]*)"),
       "the header '$1' is not complete. Write [name] or [[name]]"},
      {any, std::regex("\\s*//[^]*"), "a comment must begin with '#'"},
      {std::regex("comment or whitespace, saw '/'"), any, "a comment must begin with '#'"},
      {std::regex("expected '='"), std::regex("\\s*([\\w.-]+)\\s*:\\s*([^]*)"),
       "there is a ':' after the key '$1'. Write $1 = $2"},
      {std::regex("expected '='"), any,
       "there is no '=' after the key. Write key = value; a key has no blanks"},
      {std::regex("key-value pair: (encountered end|expected.*saw '\\\\n')|value: encountered end"),
       std::regex("\\s*([^=\\s]+)\\s*=?\\s*[-+]?\\s*"), "the key '$1' has no value"},
      {std::regex("determine value type|parsing value"),
       std::regex("\\s*([^=\\s]+)\\s*=\\s*(#[^]*)?"), "the key '$1' has no value"},
      // Arrays and what follows a value.
      {std::regex("parsing array"), any,
       "an array is not closed, or lacks a comma. Write [a, b, c]"},
      {std::regex("inline table"), any,
       "a table in braces is not closed. Write { key = value, key = value } on one line"},
      {std::regex("expected a comment or whitespace"), any,
       "there is more after the value. Write each key on a line of its own, and comments after "
       "'#'"},
      {std::regex("root table"), std::regex("\\s*<[^]*"), "this is XML, not TOML"},
      {std::regex("root table"), std::regex("\\s*\\{[^]*"), "this is JSON, not TOML"},
      {std::regex("root table"), any,
       "the line is neither key = value, a header [name], nor a comment after '#'"},
  };
  return all;
}

bool is_utf16(std::string_view text) {
  const std::string_view begin = text.substr(0, 2);
  return begin == "\xff\xfe" || begin == "\xfe\xff" ||
         (text.size() > 3 && (text[0] == '\0') != (text[1] == '\0') &&
          (text[2] == '\0') == (text[0] == '\0'));
}

}  // namespace

std::string wrong_encoding(std::string_view text) {
  if (is_utf16(text)) return "the file is in UTF-16. Save it as UTF-8";
  if (text.find('\0') != std::string_view::npos)
    return "the file has a NUL character: it is not a text file";
  return "";
}

std::string_view line_of_text(std::string_view text, int number) {
  for (int i = 1; i < number && !text.empty(); ++i)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

std::string syntax_error(std::string_view line, std::string_view parser) {
  // Longer lines would exhaust the stack of std::regex.
  constexpr std::size_t kLongest = 200;
  while (line.ends_with('\r')) line.remove_suffix(1);
  const std::string text(line.substr(0, kLongest)), words(parser.substr(0, kLongest));
  for (const Mistake& mistake : mistakes()) {
    std::smatch parts;
    if (std::regex_search(words, mistake.parser) && std::regex_match(text, parts, mistake.line))
      return parts.format(mistake.message);
  }
  return "not valid TOML: " + std::string(parser);
}

}  // namespace tether::toml
