#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <tether/base/error.h>

/// For tests that read files which people write.
namespace tether::scenario {

/// A folder of the running test's own, gone with it. @pre a test is running.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  /// Writes the file, with its folders, and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path folder_;
};

/// The message of the Error of that code that `action` throws; fails the test when there is none.
template <class Action>
std::string error_message(ErrorCode code, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(name(error.code()), name(code));
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

}  // namespace tether::scenario
