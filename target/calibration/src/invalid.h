#pragma once

#include <string>

#include <tether/base/result.h>

namespace tether::calibration {

/// `why` is one line for a person.
inline Failure invalid(const std::string& why) {
  return {Failure::Kind::kInvalid, why};
}

}  // namespace tether::calibration
