#pragma once

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace tether::app {

/// Writes to stderr. Where that cannot be written, on a full disk, say, nobody is told: it is no
/// reason to end what is under way.
template <class... Arguments>
void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  std::fputs(fmt::format(format, std::forward<Arguments>(arguments)...).c_str(), stderr);
}

}  // namespace tether::app
