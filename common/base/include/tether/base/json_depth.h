#pragma once

#include <string_view>

namespace tether {

/// Deepest nesting of objects and lists in a JSON text that Tether reads, the outermost counted.
/// Code that reads, copies or frees a document recurses once per level, so the limit bounds the
/// stack that a file can use.
inline constexpr int kMaxJsonDepth = 64;
/// The same for a text of a SUT, which becomes part of messages and results of Tether.
inline constexpr int kMaxSutJsonDepth = kMaxJsonDepth - 4;

/// The deepest nesting of brackets outside strings, for any text; a JSON reader nests no deeper.
int json_depth(std::string_view text);

}  // namespace tether
