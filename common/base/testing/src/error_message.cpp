#include <gtest/gtest.h>

#include <tether/base_testing/error_message.h>

namespace tether {

std::string error_message(ErrorCode code, const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(name(error.code()), name(code));
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

}  // namespace tether
