#include <cerrno>

#include <gtest/gtest.h>

#include <tether/base/error.h>

namespace tether {
namespace {

TEST(ReasonOf, IsTheTextOfTheSystemAndAdviceAboutDescriptors) {
  EXPECT_EQ(reason_of(ENOENT), "No such file or directory");
  for (const int error : {EMFILE, ENFILE})
    EXPECT_NE(reason_of(error).find("ulimit -n"), std::string::npos);
}

TEST(NameOfSignal, HasItsNumberAndItsDescription) {
  EXPECT_EQ(name_of_signal(9), "signal 9 (Killed)");
}

}  // namespace
}  // namespace tether
