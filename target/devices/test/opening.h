#pragma once

#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include <tether/base/result.h>

/// What opening a device gave, as a test expects it.
namespace tether::devices {

/// @pre it was opened; fails the test if not
template <class Device>
std::unique_ptr<Device> opened(Result<std::unique_ptr<Device>> device) {
  EXPECT_TRUE(device) << device.failure().message;
  return std::move(*device);
}

/// Why it was refused, which begins with the device's label; "opened" if it was not.
template <class Device>
std::string refusal(const Result<std::unique_ptr<Device>>& device, const std::string& label) {
  EXPECT_FALSE(device);
  EXPECT_EQ(device.failure().kind, Failure::Kind::kInvalid);
  EXPECT_THAT(device.failure().message, testing::StartsWith(label + ": "));
  return device.failure().message;
}

}  // namespace tether::devices
