#pragma once

#include <string_view>

namespace tether {

/// Most objects and lists within each other in a JSON text that Tether reads, the outermost
/// counted. Whoever reads, copies or frees a document recurses as deep as it is nested, so what a
/// file says must not decide how much stack that takes.
inline constexpr int kMaxJsonDepth = 64;
/// The same for a text of a SUT, which is written into messages and results of ours.
inline constexpr int kMaxSutJsonDepth = kMaxJsonDepth - 4;

/// The deepest nesting of brackets outside strings; a JSON reader nests no deeper, whatever the
/// text.
int json_depth(std::string_view text);

}  // namespace tether
