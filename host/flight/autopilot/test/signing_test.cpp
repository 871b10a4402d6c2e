#include <optional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

using testing::ElementsAre;

/// Sends back what it receives, and ignores the second message.
class Returning final : public FlightController {
 public:
  void boot(const Sensed&) override { has_booted = true; }
  Actions step(const Sensed&, const std::vector<Bytes>& received) override {
    Actions actions{.setpoint = {}, .sent = received};
    if (received.size() > 1) actions.refused = {{1, "ignored"}};
    return actions;
  }
  std::string version() const override { return has_booted ? "1.2.3" : ""; }
  bool has_booted = false;
};

const std::string kDigits(64, '5');

class SigningTest : public testing::Test {
 protected:
  const mavlink::SigningKey key_ = *mavlink::key_of_file(kDigits);
  const std::unique_ptr<FlightController> controller_ =
      with_signing(std::make_unique<Returning>(), kDigits);
  mavlink::Signer signer_{key_, 2, std::uint64_t{1} << 46};
  const mavlink::Message ping_ = mavlink::Message("PING").set("seq", 7);
  const Bytes unsigned_ = mavlink::encode(ping_, {1, 191}, 0);
};

TEST(SigningKeyOfAController, IsCheckedBeforeTheRun) {
  EXPECT_EQ(complaint_about_signing_key(kDigits + "\n"), "");
  EXPECT_THAT(complaint_about_signing_key("55"), testing::HasSubstr("64 hexadecimal digits"));
}

TEST_F(SigningTest, TakesWhatIsSignedAndSignsWhatTheControllerSends) {
  const Bytes bytes = mavlink::encode(ping_, {1, 191}, 0, &signer_);
  const Actions actions = controller_->step({}, {bytes});
  EXPECT_TRUE(actions.refused.empty());
  ASSERT_EQ(actions.sent.size(), 1U);
  const auto frames = mavlink::Decoder(&key_).push_datagram(actions.sent[0]);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].message.integer("seq"), 7);
  const Actions again = controller_->step({}, {bytes});
  ASSERT_EQ(again.refused.size(), 1U);
  EXPECT_EQ(again.refused[0].why, "old_signature");
}

TEST_F(SigningTest, SaysWhichMessagesItRefusesAndWhy) {
  mavlink::Signer other(mavlink::key_of_passphrase("x"), 2, std::uint64_t{1} << 46);
  const Actions actions =
      controller_->step({}, {unsigned_, mavlink::encode(ping_, {1, 191}, 0, &signer_),
                             mavlink::encode(ping_, {1, 191}, 0, &other),
                             mavlink::encode(ping_, {1, 191}, 1, &signer_)});
  EXPECT_EQ(actions.sent.size(), 2U);
  ASSERT_EQ(actions.refused.size(), 3U);
  EXPECT_EQ(actions.refused[2].received, 3U);
  EXPECT_EQ(actions.refused[2].why, "ignored");
  EXPECT_EQ(actions.refused[0].received, 0U);
  EXPECT_EQ(actions.refused[0].why, "not_signed");
  EXPECT_EQ(actions.refused[1].received, 2U);
  EXPECT_EQ(actions.refused[1].why, "wrong_signature");
}

// Its clock: 2026-01-01 and ST, in 10 µs since 2015.
TEST_F(SigningTest, RefusesWhatWasSignedLongBefore) {
  constexpr std::uint64_t kNow = 347'155'200ULL * 100'000, kMinute = 6'000'000;
  mavlink::Signer recorded(key_, 2, kNow - kMinute - 1), now(key_, 3, kNow - kMinute);
  EXPECT_EQ(controller_->step({}, {mavlink::encode(ping_, {1, 1}, 0, &recorded)}).refused.size(),
            1U);
  EXPECT_EQ(controller_->step({}, {mavlink::encode(ping_, {1, 1}, 0, &now)}).refused.size(), 0U);
}

TEST_F(SigningTest, LeavesTheRestToTheController) {
  EXPECT_EQ(controller_->version(), "");
  controller_->boot({});
  EXPECT_EQ(controller_->version(), "1.2.3");
}

}  // namespace
}  // namespace tether::autopilot
