#include "handles.h"

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include <tether/link/server.h>

namespace tether::c_api {
namespace {

using testing::HasSubstr;

/// The other end over TCP: welcomes who has the token, and grants every request at its timestamp.
class Coordinator {
 public:
  Coordinator() {
    server_ = link::listen_tcp({"127.0.0.1", 0}, std::chrono::seconds(5));
    thread_ = std::thread([this] {
      while (!stopping_)
        for (const link::Event& event : server_->poll(std::chrono::milliseconds(20)))
          if (const auto* message = std::get_if<link::Message>(&event.what))
            on_message(event.peer, *message);
    });
  }
  ~Coordinator() {
    stopping_ = true;
    thread_.join();
  }
  std::string address() const { return link::to_string(server_->address()); }

 private:
  void on_message(link::PeerId peer, const link::Message& message) {
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

TEST_F(Connect, ReportsWhyItCannot) {
  EXPECT_EQ(tether_connect(options_, nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_INVALID) << "no address";
  ASSERT_EQ(tether_options_set_address(options_, "127.0.0.1:1"), TETHER_OK);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_INVALID) << "no token";
  ASSERT_EQ(tether_options_set_token(options_, "another"), TETHER_OK);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_DISCONNECTED);
  EXPECT_THAT(tether_last_error(), HasSubstr("127.0.0.1:1"));
  const Coordinator coordinator;
  ASSERT_EQ(tether_options_set_address(options_, coordinator.address().c_str()), TETHER_OK);
  EXPECT_EQ(tether_connect(options_, &vehicle_), TETHER_REFUSED);
  EXPECT_STREQ(tether_last_error(), "wrong token");
  EXPECT_EQ(vehicle_, nullptr);
}

class Environment : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name :
         {"TETHER_ADDRESS", "TETHER_TOKEN", "TETHER_UAV", "TETHER_CLOCK", "TETHER_EXEC"})
      unsetenv(name);
  }
  void TearDown() override { SetUp(); }
  static void set(const char* name, const char* value) { setenv(name, value, 1); }
};

TEST_F(Environment, OptionsReplaceTheEnvironment) {
  const Coordinator coordinator;
  set("TETHER_ADDRESS", coordinator.address().c_str());
  set("TETHER_TOKEN", "word");
  set("TETHER_UAV", "uav2");
  set("TETHER_CLOCK", "scripted*2");
  tether_vehicle* vehicle = nullptr;
  ASSERT_EQ(tether_connect(nullptr, &vehicle), TETHER_OK) << tether_last_error();
  EXPECT_THAT(tether_uav_name(vehicle), HasSubstr("uav2 of tether_client_c_api_test"));
  EXPECT_EQ(tether_now(vehicle), 2'000'000);
  tether_disconnect(vehicle);

  tether_options* options = nullptr;
  ASSERT_EQ(tether_options_from_environment(&options), TETHER_OK) << tether_last_error();
  ASSERT_EQ(tether_options_set_uav(options, "uav3"), TETHER_OK);
  ASSERT_EQ(tether_options_set_clock(options, "scripted*3"), TETHER_OK);
  ASSERT_EQ(tether_connect(options, &vehicle), TETHER_OK) << tether_last_error();
  EXPECT_THAT(tether_uav_name(vehicle), HasSubstr("uav3"));
  EXPECT_EQ(tether_now(vehicle), 3'000'000);
  tether_disconnect(vehicle);
  tether_options_free(options);
}

TEST_F(Environment, NamesTheMissingVariable) {
  tether_options* options = nullptr;
  EXPECT_EQ(tether_options_from_environment(&options), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("TETHER_ADDRESS"));
  EXPECT_EQ(options, nullptr);
  tether_vehicle* vehicle = nullptr;
  EXPECT_EQ(tether_connect(nullptr, &vehicle), TETHER_INVALID);
  tether_disconnect(nullptr);
  EXPECT_EQ(tether_is_concurrent(nullptr), 0);
}

}  // namespace
}  // namespace tether::c_api
