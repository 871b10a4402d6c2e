#include <cmath>
#include <future>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

using namespace std::chrono_literals;

protocol::Open open_request() {
  protocol::Open open;
  open.world_name = "w";
  open.world_file = "/w.sdf";
  open.step = 1ms;
  return open;
}

class HostLineTest : public ::testing::Test {
 protected:
  HostLineTest() {
    auto listener = protocol::listen(scratch_.path() / "s");
    line_ = std::make_unique<HostLine>(std::move(*listener),
                                       [this](const End& end) { ended_.set_value(end); });
    host_ = protocol::connect(scratch_.path() / "s", 10s).value();
  }

  /// The host opens the world and waits for the answer.
  void open() {
    ASSERT_TRUE(host_->send(protocol::Request(open_request())));
    ASSERT_TRUE(line_->next());
  }
  std::string how_it_ended() { return ended_.get_future().get().wrong; }

  ScratchFolder scratch_;
  std::promise<End> ended_;
  std::unique_ptr<HostLine> line_;
  std::unique_ptr<protocol::Connection> host_;
};

TEST_F(HostLineTest, CarriesRequestsAndAnswers) {
  ASSERT_TRUE(host_->send(protocol::Request(open_request())));
  const auto request = line_->next();
  ASSERT_TRUE(request);
  EXPECT_EQ(std::get<protocol::Open>(*request).world_name, "w");
  line_->answer(protocol::Opened{"me", {}});
  const auto reply = host_->receive_reply(10s);
  ASSERT_TRUE(reply);
  EXPECT_EQ(std::get<protocol::Opened>(*reply).description, "me");
}

TEST_F(HostLineTest, EndsInOrderWhenTheHostLeavesBetweenRequests) {
  host_->close();
  EXPECT_EQ(how_it_ended(), "");
  EXPECT_FALSE(line_->next());
}

TEST_F(HostLineTest, NoticesAHostThatLeavesWhileTheWorldIsBusy) {
  open();
  host_->close();
  EXPECT_NE(how_it_ended(), "");
  EXPECT_TRUE(line_->is_stopped());
}

TEST_F(HostLineTest, EndsWithTheReasonSentToTheHost) {
  open();
  line_->answer(protocol::Failed{"another world"});
  ASSERT_TRUE(host_->receive_reply(10s));
  host_->close();
  EXPECT_EQ(how_it_ended(), "another world");
}

TEST_F(HostLineTest, RefusesAnAnswerThatIsNotFinite) {
  open();
  protocol::Opened opened{"me", {}};
  opened.state.bodies.resize(1);
  opened.state.bodies[0].v_WB.x = std::nan("");
  line_->answer(opened);
  EXPECT_FALSE(line_->next());
  const auto reply = host_->receive_reply(10s);
  ASSERT_TRUE(reply);
  const std::string why = std::get<protocol::Failed>(*reply).message;
  EXPECT_NE(why.find("State.bodies"), std::string::npos) << why;
  host_->close();
  EXPECT_EQ(how_it_ended(), why);
}

TEST_F(HostLineTest, EndsWhenAnAnswerDoesNotReachTheHost) {
  open();
  host_->close();
  line_->answer(protocol::Opened{"me", {}});
  (void)how_it_ended();
  EXPECT_FALSE(line_->next());
}

TEST_F(HostLineTest, EndsAtARequestThatIsNotAllowed) {
  ASSERT_TRUE(host_->send(protocol::Request(protocol::Reset{})));
  EXPECT_NE(how_it_ended(), "");
}

TEST_F(HostLineTest, StopUnblocksTheWait) {
  auto waiting = std::async(std::launch::async, [this] { return line_->next(); });
  line_->stop();
  EXPECT_FALSE(waiting.get());
}

TEST_F(HostLineTest, CanBeDestroyedWhileTheHostIsThere) {
  line_.reset();
  EXPECT_FALSE(host_->receive_reply(10s));
}

// Its host is accepted only when it is closed: `accept` had it in hand by then.
class LateListener : public protocol::Listener {
 public:
  explicit LateListener(std::unique_ptr<protocol::Listener> listener)
      : listener_(std::move(listener)) {}
  Result<std::unique_ptr<protocol::Connection>> accept() override {
    closed_.get_future().wait();
    return listener_->accept();
  }
  protocol::Endpoint endpoint() const override { return listener_->endpoint(); }
  void close() override { closed_.set_value(); }

 private:
  std::unique_ptr<protocol::Listener> listener_;
  std::promise<void> closed_;
};

TEST(HostLine, CanBeDestroyedWhileTheHostIsBeingAccepted) {
  const ScratchFolder scratch;
  auto listener = protocol::listen(scratch.path() / "s");
  ASSERT_TRUE(listener);
  auto line = std::make_unique<HostLine>(std::make_unique<LateListener>(std::move(*listener)),
                                         [](const End&) {});
  auto host = protocol::connect(scratch.path() / "s", 10s);
  ASSERT_TRUE(host);
  line.reset();
  EXPECT_FALSE((*host)->receive_reply(10s));
}

}  // namespace
}  // namespace tether::gazebo_plugin
