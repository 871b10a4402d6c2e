#include "handles.h"

#include <string>

#include <gmock/gmock.h>

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

TEST_F(Options, RefuseBadValuesAndKeepTheOldOnes) {
  ASSERT_EQ(tether_options_set_address(options_, "board:5200"), TETHER_OK);
  EXPECT_EQ(tether_options_set_address(options_, "nowhere"), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("nowhere"));
  EXPECT_EQ(options_->address->host, "board");
  EXPECT_EQ(tether_options_set_clock(options_, "sundial"), TETHER_INVALID);
  EXPECT_THAT(tether_last_error(), HasSubstr("sundial"));
  EXPECT_FALSE(options_->clock.has_value());
  EXPECT_EQ(tether_options_set_timeouts(options_, 1, 0), TETHER_INVALID);
  EXPECT_FALSE(options_->connect_timeout.has_value());
  EXPECT_EQ(tether_options_set_token(options_, nullptr), TETHER_INVALID);
  EXPECT_EQ(tether_options_set_token(nullptr, "word"), TETHER_INVALID);
  EXPECT_EQ(tether_options_new(nullptr), TETHER_INVALID);
}

}  // namespace
}  // namespace tether::c_api
