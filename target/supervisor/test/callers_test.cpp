#include "callers.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/client/exec/clock_page.h>

namespace tether::supervisor {
namespace {

using client::LocalSocket;

/// What the callers have said, as it came.
struct Heard {
  Callers::Events events() {
    return {[this](CallerId caller, link::Message message) {
              messages.emplace_back(caller, std::move(message));
            },
            [this](CallerId caller) { gone.push_back(caller); }};
  }
  std::vector<std::pair<CallerId, link::Message>> messages;
  std::vector<CallerId> gone;
};

class CallersTest : public testing::Test {
 protected:
  CallersTest()
      : path_(scratch_.path("socket").string()),
        clock_(client::make_clock_page().value()),
        callers_(client::listen_local(path_).value(), clock_.descriptor) {}

  LocalSocket call() { return client::connect_local(path_).value(); }
  void receive() { callers_.receive_all(heard_.events()); }

  ScratchFolder scratch_;
  std::string path_;
  client::SharedClockPage clock_;
  Callers callers_;
  Heard heard_;
};

TEST_F(CallersTest, GivesEachConnectionTheClockAndAnIdentity) {
  LocalSocket first = call(), second = call();
  ASSERT_TRUE(first.send(link::Progress{ExecTime(Duration(1))}));
  ASSERT_TRUE(second.send(link::Progress{ExecTime(Duration(2))}));
  receive();
  ASSERT_EQ(heard_.messages.size(), 2u);
  EXPECT_NE(heard_.messages[0].first, heard_.messages[1].first);
  for (LocalSocket* socket : {&first, &second}) {
    const auto packet = socket->receive(Duration(0));
    ASSERT_TRUE(packet);
    EXPECT_TRUE(packet->clock_page);
  }
}

TEST_F(CallersTest, AnswersTheCallerOfTheRequest) {
  LocalSocket first = call(), second = call();
  ASSERT_TRUE(first.send(link::Progress{ExecTime(Duration(1))}));
  receive();
  ASSERT_EQ(heard_.messages.size(), 1u);
  callers_.send(heard_.messages[0].first, link::Progress{ExecTime(Duration(3))});
  for (LocalSocket* socket : {&first, &second}) ASSERT_TRUE(socket->receive(Duration(0)));
  const auto answer = first.receive(Duration(0));
  ASSERT_TRUE(answer);
  EXPECT_TRUE(std::holds_alternative<link::Progress>(answer->message.value()));
  EXPECT_FALSE(second.receive(Duration(0)));
}

TEST_F(CallersTest, SaysThatACallerHasGoneBeforeThatWasHeard) {
  CallerId gone = 0;
  {
    LocalSocket caller = call();
    ASSERT_TRUE(caller.send(link::Progress{ExecTime(Duration(1))}));
    receive();
    gone = heard_.messages.at(0).first;
    EXPECT_TRUE(callers_.send(gone, link::Progress{}));
  }
  EXPECT_FALSE(callers_.send(gone, link::Progress{}));
  EXPECT_FALSE(callers_.send(gone, link::Progress{})) << "and goes on to do so";
}

TEST_F(CallersTest, ReportsClosedConnectionsButNotDroppedOnes) {
  LocalSocket dropped = call();
  {
    LocalSocket caller = call();
    for (LocalSocket* socket : {&dropped, &caller}) {
      ASSERT_TRUE(socket->send(link::Progress{ExecTime(Duration(1))}));
    }
    receive();
    EXPECT_TRUE(heard_.gone.empty());
  }
  callers_.drop(heard_.messages.at(0).first);
  receive();
  ASSERT_EQ(heard_.gone.size(), 1u);
  EXPECT_EQ(heard_.gone[0], heard_.messages.at(1).first);
  ASSERT_TRUE(dropped.receive(Duration(0))) << "the clock page";
  EXPECT_EQ(dropped.receive(Duration(0)).failure().kind, Failure::Kind::kDisconnected);
}

}  // namespace
}  // namespace tether::supervisor
