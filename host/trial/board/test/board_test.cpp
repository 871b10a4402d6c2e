#include "fake_ssh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/board/board.h>
#include <tether/os/text_file.h>

/// With the real scripts, on this machine. Over real SSH: tests/system/board/board_test.cpp.
namespace tether::board {
namespace {

constexpr Duration kLong = std::chrono::seconds(60);

class HeldBoard : public testing::Test {
 protected:
  BoardSut shell(const std::string& script) const {
    return {.uav = "uav1",
            .words = {"sh", "-c", script},
            .program = 0,
            .supervisor = 0,
            .environment = {{"TETHER_UAV", "uav1"}},
            .log = log_};
  }
  /// Runs it to its end.
  SutEnd run(const BoardSut& sut) {
    const auto process = board_.start(sut);
    EXPECT_TRUE(process->wait(kLong));
    return board_.end_of(*process->poll(), os::last_line(os::read_whole(log_)));
  }

  FakeSsh ssh_;
  const std::filesystem::path log_ = ssh_.scratch().path("sut.log");
  Board board_{FakeSsh::address()};
};

TEST_F(HeldBoard, CannotBeReservedByAnotherRun) {
  EXPECT_EQ(board_.host_address(), "192.0.2.1");
  EXPECT_EQ(board_.lost(), std::nullopt);
  const Error error =
      thrown_error(ErrorCode::kSetup, [] { const Board second(FakeSsh::address()); });
  EXPECT_EQ(error.subject(), "ssh://pi@board");
  EXPECT_THAT(error.what(), testing::HasSubstr("pid " + std::to_string(getpid())));
}

TEST_F(HeldBoard, CopiesFilesUnchanged) {
  const std::string bytes = std::string("\0\n'\\", 4) + std::string(1 << 17, 'x');
  const std::string there = board_.copy(ssh_.scratch().write("a file", bytes));
  EXPECT_THAT(there, testing::EndsWith("/a file"));
  EXPECT_EQ(os::read_whole(there), bytes);
}

TEST_F(HeldBoard, RunsASutAndCopiesItsFilesBack) {
  EXPECT_EQ(run(shell("echo \"$TETHER_UAV\"; echo text >\"$TETHER_OUT/left\"; exit 3")).description,
            "exited with code 3");
  EXPECT_EQ(os::read_whole(log_), "uav1\n");
  const auto here = ssh_.scratch().path("here");
  std::filesystem::create_directory(here);
  EXPECT_EQ(board_.bring_back("uav1", here), std::nullopt);
  EXPECT_EQ(os::read_whole(here / "left"), "text\n");
}

TEST_F(HeldBoard, ReportsHowASutEnded) {
  EXPECT_EQ(run(shell("kill -SEGV $$")).description, "was ended by signal 11 (Segmentation fault)");
  BoardSut sut = shell("");
  sut.words.front() = "no-such-program-of-tether";
  const SutEnd end = run(sut);
  EXPECT_EQ(end.cause, SutEndCause::kNotStarted);
  EXPECT_THAT(end.description, testing::HasSubstr("\"no-such-program-of-tether\""));
}

TEST_F(HeldBoard, EndsItsSuts) {
  const auto process = board_.start(shell("echo ready; exec sleep 600"));
  while (os::read_whole(log_).empty()) ASSERT_FALSE(process->wait(Duration(0)));
  EXPECT_TRUE(board_.end_suts());
  EXPECT_TRUE(process->wait(kLong));
}

TEST(Board, LeavesNothingBehind) {
  const FakeSsh ssh;
  std::filesystem::path copy;
  {
    Board board(FakeSsh::address());
    copy = board.copy(ssh.scratch().write("file", "text"));
    EXPECT_TRUE(std::filesystem::exists(copy));
    EXPECT_TRUE(std::filesystem::exists(ssh.scratch().path("lock")));
  }
  EXPECT_FALSE(std::filesystem::exists(copy.parent_path().parent_path().parent_path()));
  EXPECT_FALSE(std::filesystem::exists(ssh.scratch().path("lock")));
}

}  // namespace
}  // namespace tether::board
