#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Small texts and names.
namespace tether {

/// The UTF-8 text with '?' for each control character, so that it cannot break lines or control a
/// terminal, and without blanks at its ends.
std::string printable(const std::string& text);

/// "1 flight", "3 flights".
std::string counted(std::size_t count, std::string_view noun);

/// With small letters in place of A to Z, in any locale.
std::string lower_case(std::string_view text);

/// The text of which a URI has this: "Ground Plane" of "Ground%20Plane". What is no code stays.
std::string unescaped(std::string_view uri);

/// The name of an enumerator, from the names of all enumerators in order; "unknown" for a value
/// beyond them. @pre the enumerators are 0, 1, 2, …; `names` are literals.
template <class Enum>
constexpr std::string_view enum_name(Enum value, std::initializer_list<std::string_view> names) {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names.begin()[index] : "unknown";
}

/// The candidate that a user who wrote `word` most likely meant: the nearest by edit distance
/// (insertion, deletion, substitution, transposition) if the distance is small for its length, or
/// one that differs only in its unit suffix or is longer. Empty if there is none.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// Whether a word of at least four letters is one with a single mistake (as above): not another
/// word on purpose, such as one with another unit suffix.
bool is_misspelt(std::string_view word, std::string_view candidate);

/// "'a', 'b' and 'c'"; "none" for an empty list.
std::string quoted_list(std::span<const std::string_view> words);

/// After "…; ": "allowed: 'a' and 'b'", or "did you mean 'a'? Allowed: 'a' and 'b'" where `nearest`
/// finds one.
std::string allowed_hint(std::string_view word, std::span<const std::string_view> candidates);

/// Of texts that do not depend on the width of a terminal.
inline constexpr std::size_t kAnyColumns = std::numeric_limits<std::size_t>::max();

/// The columns that a UTF-8 text of one line takes, without those of escape sequences for colours.
std::size_t columns_of(const std::string& text);

/// Rows of cells as lines of columns, the first two aligned to the left and the others to the
/// right, without blanks at the end. A row may have fewer cells than others. If a line would be
/// longer than `columns`, `text_lists` of the rows below the first one, which has the headings.
std::string text_table(const std::vector<std::vector<std::string>>& rows,
                       std::size_t columns = kAnyColumns);

/// A block of lines for each row: its first cell, then a line with the heading and the text of each
/// other cell that is not empty. Not longer than `columns`, if the words are not.
std::string text_lists(const std::vector<std::string>& headings,
                       const std::vector<std::vector<std::string>>& rows, std::size_t columns);

/// Breaks lines that are longer than `columns` between words. The rest of a line begins below its
/// text: what follows its mark ("→ ", "- ") or its label, which two blanks or more end. Longer
/// words stay whole.
std::string wrapped(const std::string& text, std::size_t columns);

/// The number with `digits` digits after the point, in any locale.
std::string fixed(double value, int digits);

/// The number with `digits` significant digits, or with as many more as it needs to differ from
/// another number, such as its limit.
std::string distinct_text(double value, double other, int digits);

/// Deepest nesting of objects and lists in a JSON text that Tether reads, the outermost counted.
/// Code that reads, copies or frees a document recurses once per level, so the limit bounds the
/// stack that a file can use.
inline constexpr int kMaxJsonDepth = 64;
/// The same for a text of a SUT, which becomes part of messages and results of Tether.
inline constexpr int kMaxSutJsonDepth = kMaxJsonDepth - 4;

/// The deepest nesting of brackets outside strings, for any text; a JSON reader nests no deeper.
int json_depth(std::string_view text);

}  // namespace tether
