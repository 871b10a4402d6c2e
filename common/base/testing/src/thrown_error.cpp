#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether {

Error thrown_error(ErrorCode code, const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(name(error.code()), name(code)) << error.what();
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::kInternal, ""};
}

}  // namespace tether
