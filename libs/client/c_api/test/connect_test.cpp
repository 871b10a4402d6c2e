#include "handles.h"

#include <atomic>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/link/server.h>

namespace tether::c_api {
namespace {

using testing::HasSubstr;

/// The other end over TCP: welcomes who has the token, and grants every request at its timestamp.
class Coordinator final : public link::ServerEvents {
 public:
  Coordinator() {
    server_ = link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(5), *this);
    thread_ = std::thread([this] {
      while (!stopping_) server_->poll(std::chrono::milliseconds(20));
    });
  }
  ~Coordinator() override {
    stopping_ = true;
    thread_.join();
  }
  std::string address() const { return link::to_string(server_->address()); }

 private:
  void on_connected(link::PeerId, const std::string&) override {}
  void on_closed(link::PeerId, const Failure&) override {}
  void on_message(link::PeerId peer, link::Message message) override {
    if (const auto* hello = std::get_if<link::Hello>(&message)) greet(peer, *hello);
    if (const auto* request = std::get_if<link::Request>(&message))
      server_->send(peer, link::Reply{request->sequence, request->issued_at, std::nullopt});
  }
  void greet(link::PeerId peer, const link::Hello& hello) {
    if (hello.token != "word")
      return server_->send(peer, link::Refusal{link::Refusal::Reason::kToken, "wrong token"});
    link::Welcome welcome;
    welcome.catalogue.uav = hello.uav + " of " + hello.sut;
    server_->send(peer, welcome);
  }

  std::unique_ptr<link::Server> server_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

class Connect : public testing::Test {
 protected:
  Connect() {
    EXPECT_EQ(tether_options_new(&options_), TETHER_OK);
    EXPECT_EQ(tether_options_set_clock(options_, "scripted*1"), TETHER_OK);
    EXPECT_EQ(tether_options_set_uav(options_, "uav1"), TETHER_OK);
    EXPECT_EQ(tether_options_set_sut_name(options_, "pilot"), TETHER_OK);
  }
  ~Connect() override { tether_options_free(options_); }
  tether_options* options_ = nullptr;
  tether_vehicle* vehicle_ = nullptr;
};

TEST_F(Connect, FliesMoreThanOnceWithTheSameOptions) {
  const Coordinator coordinator;
  ASSERT_EQ(tether_options_set_address(options_, coordinator.address().c_str()), TETHER_OK);
  ASSERT_EQ(tether_options_set_token(options_, "word"), TETHER_OK);
  for (int flight = 0; flight < 2; ++flight) {
    ASSERT_EQ(tether_connect(options_, &vehicle_), TETHER_OK) << tether_last_error();
    EXPECT_STREQ(tether_uav_name(vehicle_), "uav1 of pilot");
    EXPECT_EQ(tether_is_concurrent(vehicle_), 0);
    EXPECT_EQ(tether_sleep_for(vehicle_, 5), TETHER_OK) << tether_last_error();
    EXPECT_EQ(tether_finish(vehicle_, 1, "there", ""), TETHER_OK);
    EXPECT_EQ(tether_sleep_for(vehicle_, 5), TETHER_INVALID);
    tether_disconnect(vehicle_);
  }
}

TEST_F(Connect, PassesOnTheCoordinatorsWords) {
  const Coordinator coordinator;
  ASSERT_EQ(tether_options_set_address(options_, coordinator.address().c_str()), TETHER_OK);
  ASSERT_EQ(tether_options_set_token(options_, "another"), TETHER_OK);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_REFUSED);
  EXPECT_STREQ(tether_last_error(), "wrong token");
  EXPECT_EQ(vehicle_, nullptr);
}

TEST_F(Connect, NeedsAddressAndToken) {
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("no address"));
  ASSERT_EQ(tether_options_set_address(options_, "127.0.0.1:1"), TETHER_OK);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("no token"));
  EXPECT_EQ(tether_connect(options_, nullptr), TETHER_INVALID);
}

TEST_F(Connect, SaysWhereNobodyListens) {
  ASSERT_EQ(tether_options_set_address(options_, "127.0.0.1:1"), TETHER_OK);
  ASSERT_EQ(tether_options_set_token(options_, "word"), TETHER_OK);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_DISCONNECTED);
  EXPECT_THAT(tether_last_error(), HasSubstr("127.0.0.1:1"));
}

TEST(Disconnect, TakesNull) {
  tether_disconnect(nullptr);
  EXPECT_EQ(tether_is_concurrent(nullptr), 0);
}

}  // namespace
}  // namespace tether::c_api
