#include "external/ports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Sends a number at each step, and keeps what it receives.
class Counting final : public FlightController {
 public:
  explicit Counting(std::vector<Bytes>& received) : received_(&received) {}
  Actions step(const Sensed&, const std::vector<Bytes>& received) override {
    received_->insert(received_->end(), received.begin(), received.end());
    return {.setpoint = {}, .sent = {{++count_}}};
  }
  std::string version() const override { return "1.2.3"; }

 private:
  std::vector<Bytes>* received_;
  std::uint8_t count_ = 0;
};

class GroundStationTest : public testing::Test {
 protected:
  std::unique_ptr<FlightController> make(GroundStation what) {
    return with_ground_station(std::make_unique<Counting>(received_), what, station_.number());
  }
  std::vector<Bytes> seen() {
    station_.wait(std::chrono::seconds(1));
    return station_.receive();
  }
  const Bytes arm_ = mavlink::encode(mavlink::Message("COMMAND_LONG")
                                         .set("command", 400)
                                         .set("param1", 1.0)
                                         .set("target_system", 7),
                                     {255, 190}, 0);
  std::vector<Bytes> received_;
  UdpPort station_{0, "the test"};
};

TEST_F(GroundStationTest, SeesWhatTheControllerSends) {
  const auto controller = make(GroundStation::kLooks);
  EXPECT_THAT(controller->step({}, {}).sent, ElementsAre(Bytes{1})) << "to the companion, too";
  EXPECT_THAT(seen(), ElementsAre(Bytes{1}));
  EXPECT_EQ(controller->version(), "1.2.3");
}

TEST_F(GroundStationTest, ThatOnlyLooksIsDenied) {
  const auto controller = make(GroundStation::kLooks);
  controller->step({}, {{42}});
  seen();
  station_.send(arm_);
  station_.send(Bytes{1, 2, 3});
  controller->step({}, {{43}});
  EXPECT_THAT(received_, ElementsAre(Bytes{42}, Bytes{43})) << "nothing of the station's";
  const auto answers = seen();
  ASSERT_EQ(answers.size(), 2U);
  const auto frames = mavlink::Decoder().push_datagram(answers[0]);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].message.is("COMMAND_ACK"));
  EXPECT_EQ(frames[0].from.system, 7);
  EXPECT_EQ(frames[0].message.integer("command"), 400);
  EXPECT_EQ(frames[0].message.integer("result"), 2) << "denied";
  EXPECT_EQ(frames[0].message.integer("target_system"), 255);
}

TEST_F(GroundStationTest, ThatMayCommandReachesTheNextStep) {
  const auto controller = make(GroundStation::kCommands);
  controller->step({}, {});
  seen();
  station_.send(arm_);
  controller->step({}, {{43}});
  EXPECT_THAT(received_, ElementsAre(Bytes{43}, arm_));
}

TEST_F(GroundStationTest, ThatSendsWithoutEndGetsAShareOfEachStep) {
  const auto controller = make(GroundStation::kCommands);
  controller->step({}, {});
  seen();
  for (int i = 0; i < 100; ++i) station_.send(Bytes{9});
  controller->step({}, {});
  EXPECT_EQ(received_.size(), 64U);
}

TEST_F(GroundStationTest, MayBeAbsent) {
  const auto controller =
      with_ground_station(std::make_unique<Counting>(received_), GroundStation::kLooks, 9);
  for (std::uint8_t i = 1; i < 4; ++i)
    EXPECT_THAT(controller->step({}, {}).sent, ElementsAre(Bytes{i}));
  EXPECT_THAT(received_, IsEmpty());
}

}  // namespace
}  // namespace tether::autopilot
