#pragma once

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace tether::app {

/// Writes to stderr. Errors are ignored: a full disk, for example, does not end a run.
template <class... Arguments>
void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  std::fputs(fmt::format(format, std::forward<Arguments>(arguments)...).c_str(), stderr);
}

}  // namespace tether::app
