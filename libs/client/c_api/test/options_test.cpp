#include "handles.h"

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::c_api {
namespace {

using testing::HasSubstr;

class Options : public testing::Test {
 protected:
  Options() { EXPECT_EQ(tether_options_new(&options_), TETHER_OK); }
  ~Options() override { tether_options_free(options_); }
  tether_options* options_ = nullptr;
};

TEST_F(Options, KeepWhatTheyAreGiven) {
  EXPECT_THAT(options_->sut_name, HasSubstr("test"));
  ASSERT_EQ(tether_options_set_address(options_, "[::1]:5200"), TETHER_OK);
  ASSERT_EQ(tether_options_set_token(options_, "word"), TETHER_OK);
  ASSERT_EQ(tether_options_set_uav(options_, "uav2"), TETHER_OK);
  ASSERT_EQ(tether_options_set_sut_name(options_, "pilot 2.1"), TETHER_OK);
  ASSERT_EQ(tether_options_set_clock(options_, "cpu*4"), TETHER_OK);
  ASSERT_EQ(tether_options_set_timeouts(options_, 5, 7), TETHER_OK);
  EXPECT_EQ(*options_->address, (link::Address{"::1", 5200}));
  EXPECT_EQ(options_->token, "word");
  EXPECT_EQ(options_->uav, "uav2");
  EXPECT_EQ(options_->sut_name, "pilot 2.1");
  EXPECT_EQ(options_->clock, "cpu*4");
  EXPECT_EQ(options_->connect_timeout, Duration(5));
  EXPECT_EQ(options_->welcome_timeout, Duration(7));
}

TEST_F(Options, SayWhatTheyDoNotTakeAndKeepTheOld) {
  ASSERT_EQ(tether_options_set_address(options_, "board:5200"), TETHER_OK);
  EXPECT_EQ(tether_options_set_address(options_, "nowhere"), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("'nowhere'"));
  EXPECT_EQ(options_->address->host, "board");
  EXPECT_EQ(tether_options_set_clock(options_, "sundial"), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("the clock is 'sundial'; allowed are wall"));
  EXPECT_EQ(options_->clock, "wall");
  EXPECT_EQ(tether_options_set_timeouts(options_, 1, 0), TETHER_INVALID);
  EXPECT_EQ(options_->connect_timeout, std::chrono::seconds(10));
  EXPECT_EQ(tether_options_set_token(options_, nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_options_set_token(nullptr, "word"), TETHER_INVALID);
  EXPECT_EQ(tether_options_new(nullptr), TETHER_INVALID);
}

class Environment : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"TETHER_ADDRESS", "TETHER_TOKEN", "TETHER_UAV", "TETHER_CLOCK"})
      unsetenv(name);
  }
  void TearDown() override { SetUp(); }
  static void set(const char* name, const char* value) { setenv(name, value, 1); }
};

TEST_F(Environment, IsReadWhole) {
  set("TETHER_ADDRESS", "127.0.0.1:5200");
  set("TETHER_TOKEN", "word");
  set("TETHER_UAV", "uav2");
  set("TETHER_CLOCK", "scripted*2");
  tether_options* options = nullptr;
  ASSERT_EQ(tether_options_from_environment(&options), TETHER_OK) << tether_last_error();
  EXPECT_EQ(options->address->port, 5200);
  EXPECT_EQ(options->token, "word");
  EXPECT_EQ(options->uav, "uav2");
  EXPECT_EQ(options->clock, "scripted*2");
  tether_options_free(options);
}

TEST_F(Environment, NamesTheVariableThatIsWrong) {
  tether_options* options = nullptr;
  EXPECT_EQ(tether_options_from_environment(&options), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("TETHER_ADDRESS is not set"));
  EXPECT_EQ(options, nullptr);
  tether_vehicle* vehicle = nullptr;
  EXPECT_EQ(tether_connect(nullptr, &vehicle), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("TETHER_ADDRESS is not set"));
}

}  // namespace
}  // namespace tether::c_api
