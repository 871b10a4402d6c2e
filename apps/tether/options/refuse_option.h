#pragma once

#include <string>

#include <tether/base/error.h>

namespace tether::app {

/// @throws Error(kUsage), always: the option's value cannot be used.
[[noreturn]] inline void refuse_option(const std::string& option, const std::string& why) {
  throw Error(ErrorCode::kUsage, option + ": " + why).about(option);
}

}  // namespace tether::app
