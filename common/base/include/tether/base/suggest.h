#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tether {

/// The candidate that a user who wrote `word` most likely meant: the nearest by edit distance
/// (insertion, deletion, substitution, transposition) if the distance is small for its length, or
/// one that differs only in its unit suffix or is longer. Empty if there is none.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "'a', 'b' and 'c'"; "none" for an empty list.
std::string quoted_list(std::span<const std::string_view> words);

/// After "…; ": "allowed: 'a' and 'b'", or "did you mean 'a'? Allowed: 'a' and 'b'" where `nearest`
/// finds one.
std::string allowed_hint(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace tether
