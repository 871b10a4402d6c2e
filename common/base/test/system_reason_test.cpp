#include <cerrno>

#include <gtest/gtest.h>

#include <tether/base/system_reason.h>

namespace tether {
namespace {

TEST(ReasonOf, IsWhatTheSystemSays) {
  EXPECT_EQ(reason_of(ENOENT), "No such file or directory");
}

TEST(ReasonOf, SaysWhatToDoWithoutHandles) {
  EXPECT_EQ(reason_of(EMFILE), "Too many open files; allow this process more (ulimit -n)");
  EXPECT_EQ(reason_of(ENFILE),
            "Too many open files in system; allow this process more (ulimit -n)");
}

TEST(NameOfSignal, HasItsNumberAndWhatTheSystemCallsIt) {
  EXPECT_EQ(name_of_signal(9), "signal 9 (Killed)");
}

}  // namespace
}  // namespace tether
