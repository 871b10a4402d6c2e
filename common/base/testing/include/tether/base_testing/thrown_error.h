#pragma once

#include <functional>

#include <tether/base/error.h>

/// For tests of what is rejected: they compare the fields of the Error.
namespace tether {

/// The Error with that code that `action` throws; fails the test when there is none.
Error thrown_error(ErrorCode code, const std::function<void()>& action);
inline Error bad_file_error(const std::function<void()>& action) {
  return thrown_error(ErrorCode::kBadFile, action);
}

}  // namespace tether
