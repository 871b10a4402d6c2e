#include "external/held_program.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>

namespace tether::autopilot {
namespace {

class Held : public testing::Test {
 protected:
  HeldProgram start(const std::string& script) {
    return {"the controller", {.arguments = {"sh", "-c", script}, .environment = {}, .log = log_}};
  }
  std::string lost(const std::string& script) {
    HeldProgram program = start(script);
    try {
      for (;;) program.let_rest([] {}, [] {});
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kLinkLost);
      return e.what();
    }
  }
  ScratchFolder scratch_;
  std::filesystem::path log_ = scratch_.path("log");
};

TEST_F(Held, RestsOnceItHasComputed) {
  HeldProgram program =
      start("i=0; while [ $i -lt 20000 ]; do i=$((i+1)); done; echo done; sleep 60");
  int served = 0;
  program.let_rest([] {}, [&] { ++served; });
  std::ifstream log(log_);
  std::string line;
  std::getline(log, line);
  EXPECT_EQ(line, "done");
  EXPECT_GE(served, 2);
}

TEST_F(Held, IsLostWithTheLastLineOfItsLog) {
  EXPECT_THAT(lost("echo one; echo two; exit 3"),
              testing::AllOf(testing::HasSubstr("the controller exited with code 3: \"two\""),
                             testing::HasSubstr(log_.string())));
}

}  // namespace
}  // namespace tether::autopilot
