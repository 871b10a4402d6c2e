#pragma once

#include <functional>
#include <string>

#include <tether/base/error.h>

/// For tests that read files which people write.
namespace tether::scenario {

/// The message of the Error of that code that `action` throws; fails the test when there is none.
std::string error_message(ErrorCode code, const std::function<void()>& action);

}  // namespace tether::scenario
