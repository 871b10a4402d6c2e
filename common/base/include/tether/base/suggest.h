#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tether {

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

}  // namespace tether
