#pragma once

#include <functional>
#include <string>

#include <tether/base/error.h>

/// For tests of what is refused.
namespace tether {

/// The message of the Error of that code that `action` throws; fails the test when there is none.
std::string error_message(ErrorCode code, const std::function<void()>& action);

}  // namespace tether
