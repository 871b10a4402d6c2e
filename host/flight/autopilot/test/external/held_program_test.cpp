#include "external/held_program.h"

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/os/text_file.h>

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

// An answer that is taken a step later changes the flight.
TEST_F(Held, IsServedOnceMoreWhenItRests) {
  const std::filesystem::path asked = scratch_.path("asked"), never = scratch_.path("never");
  for (const auto& file : {asked, never}) ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  HeldProgram program = start("read line < '" + asked.string() + "'; echo answer; read line < '" +
                              never.string() + "'");
  const auto has_answered = [&] { return os::read_whole(log_) == "answer\n"; };
  bool is_answer_taken = false;
  program.let_rest([&] { std::ofstream(asked) << "question\n"; },
                   [&] {
                     is_answer_taken = has_answered();
                     while (!has_answered()) std::this_thread::yield();
                   });
  EXPECT_TRUE(is_answer_taken);
}

TEST_F(Held, IsLostWithTheLastLineOfItsLog) {
  EXPECT_THAT(lost("echo one; echo two; exit 3"),
              testing::AllOf(testing::HasSubstr("the controller exited with code 3: \"two\""),
                             testing::HasSubstr(log_.string())));
}

}  // namespace
}  // namespace tether::autopilot
