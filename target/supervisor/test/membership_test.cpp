#include "membership.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tether::supervisor {
namespace {

class Membership : public testing::Test {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
    member_ = os::FileDescriptor(ends[0]);
    group_ = os::FileDescriptor(ends[1]);
  }
  void hang_up(os::FileDescriptor& end) { end = os::FileDescriptor(); }

  os::FileDescriptor member_, group_;
};

TEST_F(Membership, ACommandArrivesWithItsEnvironmentAndDescriptors) {
  EXPECT_EQ(receive_program(group_.get()).failure().kind, Failure::Kind::kTimeout);
  ::setenv("TETHER_TEST", "a value\nof two lines", 1);
  ASSERT_TRUE(send_program(member_.get(), "uav1", {"fly", "", "two words"}).ok());
  ::unsetenv("TETHER_TEST");
  const auto program = receive_program(group_.get());
  ASSERT_TRUE(program) << program.failure().message;
  EXPECT_EQ(program->uav, "uav1");
  EXPECT_THAT(program->command.words, testing::ElementsAre("fly", "", "two words"));
  EXPECT_THAT(*program->command.environment,
              testing::Contains("TETHER_TEST=a value\nof two lines"));
  EXPECT_THAT(program->command.descriptors, testing::Each(testing::Gt(2)));
}

TEST_F(Membership, EndsAndSignalsArrive) {
  EXPECT_EQ(receive_signal(group_.get()), 0);
  send_signal(member_.get(), SIGINT);
  EXPECT_EQ(receive_signal(group_.get()), SIGINT);
  send_end(group_.get(), {7, "why"});
  const auto end = receive_end(member_.get());
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 7);
  EXPECT_EQ(end->message, "why");
}

TEST_F(Membership, AnEndThatHangsUpIsNoticed) {
  hang_up(member_);
  EXPECT_EQ(receive_signal(group_.get()), std::nullopt);
  EXPECT_EQ(receive_program(group_.get()).failure().kind, Failure::Kind::kDisconnected);
  SetUp();
  hang_up(group_);
  EXPECT_FALSE(receive_end(member_.get()));
  EXPECT_FALSE(send_program(member_.get(), "", {"fly"}).ok());
}

TEST_F(Membership, RefusesWhatIsNoCommand) {
  ASSERT_EQ(::send(member_.get(), "x", 1, 0), 1);
  EXPECT_EQ(receive_program(group_.get()).failure().kind, Failure::Kind::kProtocol);
  ASSERT_TRUE(send_program(member_.get(), "", {}).ok());
  EXPECT_EQ(receive_program(group_.get()).failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::supervisor
