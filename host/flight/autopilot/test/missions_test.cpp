#include "flight.h"

namespace tether::autopilot {
namespace {

constexpr long kUnsupportedItem = 3, kNoSpace = 4, kInvalid = 5, kInvalidSequence = 13,
               kCancelled = 15;
constexpr double kDegreesOfMetre = 1.0 / 110'574.3;  // of latitude at the equator

Message to_us(const char* name) {
  return Message(name).set("target_system", 1).set("target_component", 1);
}

/// An item so many metres to the north, over home.
Message item(int seq, int command, double north_m = 0.0, double z_m = 3.0, double p1 = 0.0,
             double p2 = 0.0) {
  return to_us("MISSION_ITEM_INT")
      .set("seq", seq)
      .set("frame", 6)
      .set("command", command)
      .set("autocontinue", 1)
      .set("param1", p1)
      .set("param2", p2)
      .set("param4", kNone)
      .set("x", north_m * kDegreesOfMetre * 1e7)
      .set("z", z_m);
}

struct MissionFlight : Flight {
  using Flight::Flight;
  /// Sends what it is asked for. Returns the type of MISSION_ACK; −1: none.
  long upload(const std::vector<Message>& items) {
    heard.clear();
    send(to_us("MISSION_COUNT").set("count", items.size()));
    for (int i = 0; i < 200 && last("MISSION_ACK") == nullptr; ++i) {
      const std::size_t before = count("MISSION_REQUEST_INT");
      run(0.004);
      if (count("MISSION_REQUEST_INT") == before) continue;
      const auto seq = static_cast<std::size_t>(last("MISSION_REQUEST_INT")->integer("seq"));
      if (seq < items.size()) send(items[seq]);
    }
    const Message* ack = last("MISSION_ACK");
    return ack == nullptr ? -1 : static_cast<long>(ack->integer("type"));
  }
  std::vector<long> reached() const {
    std::vector<long> found;
    for (const Message& m : heard)
      if (m.is("MISSION_ITEM_REACHED")) found.push_back(static_cast<long>(m.integer("seq")));
    return found;
  }
};

TEST(Missions, AreUploadedAndDownloaded) {
  MissionFlight flight;
  flight.boot();
  ASSERT_EQ(flight.upload({item(0, 22), item(1, 16, 5.0, 4.0, 1.5), item(2, 21, 5.0)}), 0);
  flight.heard.clear();
  flight.send(to_us("MISSION_REQUEST_LIST"), {200, 5});
  flight.send(to_us("MISSION_REQUEST_INT").set("seq", 1));
  flight.send(to_us("MISSION_REQUEST").set("seq", 1));
  flight.send(to_us("MISSION_REQUEST_INT").set("seq", 3));
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_COUNT")->integer("count"), 3);
  EXPECT_EQ(flight.last("MISSION_COUNT")->integer("target_system"), 200);
  const Message& back = *flight.last("MISSION_ITEM_INT");
  const Message sent = item(1, 16, 5.0, 4.0, 1.5);
  for (const char* field : {"seq", "frame", "command", "autocontinue", "x", "y"})
    EXPECT_EQ(back.integer(field), sent.integer(field)) << field;
  EXPECT_EQ(back.number("param1"), 1.5);
  EXPECT_EQ(back.number("z"), 4.0);
  EXPECT_NEAR(flight.last("MISSION_ITEM")->number("x"), 5.0 * kDegreesOfMetre, 1e-7);
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("type"), kInvalidSequence);
}

TEST(Missions, AskAgainForWhatIsLost) {
  MissionFlight flight;
  flight.boot();
  flight.heard.clear();
  flight.send(to_us("MISSION_COUNT").set("count", 2));
  flight.run(0.6);
  EXPECT_EQ(flight.count("MISSION_REQUEST_INT"), 3U) << "at once, and each 250 ms";
  flight.send(item(1, 16, 9.0));      // not this one
  flight.send(item(0, 22), {77, 1});  // not from this one
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_ACK"), nullptr);
  EXPECT_EQ(flight.last("MISSION_REQUEST_INT")->integer("seq"), 0);
  flight.send(item(0, 22));
  flight.send(item(0, 22));  // again
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_REQUEST_INT")->integer("seq"), 1);
  flight.send(item(1, 16, 9.0));
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("type"), 0);
  flight.heard.clear();
  flight.send(to_us("MISSION_COUNT").set("count", 1));
  flight.run(10.0);
  EXPECT_EQ(flight.count("MISSION_REQUEST_INT"), 20U);
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("type"), kCancelled);
  flight.send(to_us("MISSION_REQUEST_LIST"));
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_COUNT")->integer("count"), 2) << "the plan before is kept";
}

TEST(Missions, AreRefusedAsAWhole) {
  MissionFlight flight;
  flight.boot();
  ASSERT_EQ(flight.upload({item(0, 22)}), 0);
  EXPECT_EQ(flight.upload({item(0, 22), item(1, 18)}), kUnsupportedItem);
  EXPECT_EQ(flight.upload({item(0, 22), item(1, 16).set("frame", 9)}), 2);
  EXPECT_EQ(flight.upload({item(0, 16).set("x", 1'000'000'000)}), kInvalid);
  EXPECT_EQ(flight.upload({item(0, 16).set("z", kNone)}), kInvalid);
  EXPECT_EQ(flight.upload({item(0, 16).set("z", -1e30)}), kInvalid);
  EXPECT_EQ(flight.upload({item(0, 19).set("param1", kInfinite)}), kInvalid);
  EXPECT_EQ(flight.upload({item(0, 93).set("param1", -1.0)}), kInvalid);
  EXPECT_EQ(flight.upload({item(0, 178).set("param2", kNone)}), kInvalid);
  EXPECT_EQ(flight.upload(std::vector<Message>(1001, item(0, 22))), kNoSpace);
  flight.heard.clear();
  flight.send(to_us("MISSION_COUNT").set("count", 3).set("mission_type", 1));
  flight.send(to_us("MISSION_REQUEST_LIST"));
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("type"), kUnsupportedItem) << "no fences";
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("mission_type"), 1);
  EXPECT_EQ(flight.last("MISSION_COUNT")->integer("count"), 1) << "the plan before is kept";
}

TEST(Missions, AreNotTakenOverByAnotherSender) {
  MissionFlight flight;
  flight.boot();
  flight.send(to_us("MISSION_COUNT").set("count", 1));
  flight.run(0.004);
  flight.send(to_us("MISSION_COUNT").set("count", 2), {42, 190});
  flight.run(0.004);
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("type"), 1);
  EXPECT_EQ(flight.last("MISSION_ACK")->integer("target_system"), 42);
  EXPECT_EQ(flight.upload({item(0, 22)}), 0) << "who began it goes on";
}

TEST(Missions, AreClearedByBothWays) {
  for (const Message& clear :
       {to_us("MISSION_CLEAR_ALL"), to_us("MISSION_CLEAR_ALL").set("mission_type", 255),
        to_us("MISSION_COUNT")}) {
    MissionFlight flight;
    flight.boot();
    ASSERT_EQ(flight.upload({item(0, 22)}), 0);
    flight.heard.clear();
    flight.send(clear);
    flight.send(to_us("MISSION_REQUEST_LIST"));
    flight.run(0.004);
    EXPECT_EQ(flight.last("MISSION_ACK")->integer("type"), 0);
    EXPECT_EQ(flight.last("MISSION_COUNT")->integer("count"), 0);
    EXPECT_EQ(flight.command(300), kDenied) << "there is none to start";
  }
}

TEST(Missions, AreFlown) {
  MissionFlight flight;
  flight.boot();
  // Takes off, flies 12 m to the north, waits, is slower on the way back, waits there, and lands.
  ASSERT_EQ(flight.upload({item(0, 22, 0.0, 3.0), item(1, 16, 12.0, 4.0, 2.0, 0.3),
                           item(2, 178, 0, 0, 1, 1.0), item(3, 16, 2.0, 4.0, 0.0, 0.3),
                           item(4, 93, 0, 0, 1.0), item(5, 21, 2.0)}),
            0);
  flight.heard.clear();
  EXPECT_EQ(flight.command(300), kAccepted);
  EXPECT_TRUE(flight.is_armed()) << "the start of a mission arms";
  EXPECT_EQ(flight.shown_mode(), "AUTO.MISSION");
  std::map<long, SimTime> reached_at;
  double fastest_back = 0.0;
  flight.run_until([&] {
    for (const long seq : flight.reached()) reached_at.try_emplace(seq, flight.now);
    if (reached_at.contains(2) && !reached_at.contains(3))
      fastest_back = std::max(fastest_back, std::abs(flight.body.v_WB.y));
    if (reached_at.contains(1) && !reached_at.contains(2)) {
      EXPECT_NEAR(flight.body.p_WB.y, 12.0, 0.35);
    }
    return !flight.is_armed();
  });
  EXPECT_EQ(flight.reached(), (std::vector<long>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(flight.was_said("mission finished"));
  EXPECT_FALSE(flight.is_armed());
  EXPECT_NEAR(fastest_back, 1.0, 0.15);
  EXPECT_GT(to_seconds(reached_at[4] - reached_at[3]), 0.99);
  EXPECT_NEAR(flight.body.p_WB.y, 2.0, 0.3);
  EXPECT_EQ(flight.body.p_WB.z, 0.0);
}

TEST(Missions, HoldAWaypointForItsTime) {
  MissionFlight flight;
  flight.take_off();
  ASSERT_EQ(flight.upload({item(0, 16, 3.0, 3.0, 4.0), item(1, 20)}), 0);
  ASSERT_EQ(flight.mode(4, 4), kAccepted);
  const SimTime from = flight.now;
  ASSERT_TRUE(flight.run_until([&] { return flight.shown_mode() == "AUTO.RTL"; }, 30.0));
  EXPECT_GT(to_seconds(flight.now - from), 4.0);
  EXPECT_NEAR(flight.body.p_WB.y, 3.0, 0.1);
}

TEST(Missions, EndInHold) {
  MissionFlight flight;
  flight.take_off();
  ASSERT_EQ(flight.upload({item(0, 16, 3.0)}), 0);
  flight.mode(4, 4);
  ASSERT_TRUE(flight.run_until([&] { return flight.shown_mode() == "AUTO.LOITER"; }, 30.0));
  flight.run(1.1);
  EXPECT_EQ(flight.last("MISSION_CURRENT")->integer("seq"), 0);
  EXPECT_EQ(flight.last("MISSION_CURRENT")->integer("total"), 1);
}

TEST(Missions, WaitAtAnItemThatDoesNotGoOn) {
  MissionFlight flight;
  flight.take_off();
  ASSERT_EQ(flight.upload({item(0, 16, 3.0).set("autocontinue", 0), item(1, 16, 20.0)}), 0);
  flight.mode(4, 4);
  flight.run(15.0);
  EXPECT_EQ(flight.reached(), (std::vector<long>{0}));
  EXPECT_EQ(flight.shown_mode(), "AUTO.MISSION");
  EXPECT_NEAR(flight.body.p_WB.y, 3.0, 0.1);
  flight.send(to_us("MISSION_SET_CURRENT").set("seq", 1));
  flight.run(10.0);
  EXPECT_NEAR(flight.body.p_WB.y, 20.0, 2.1);
}

TEST(Missions, CanBeReplacedInFlight) {
  MissionFlight flight;
  flight.take_off();
  ASSERT_EQ(flight.upload({item(0, 16, 50.0)}), 0);
  flight.mode(4, 4);
  flight.run(2.0);
  ASSERT_EQ(flight.upload({item(0, 17, -4.0)}), 0);
  flight.run(20.0);
  EXPECT_NEAR(flight.body.p_WB.y, -4.0, 0.2);
  flight.send(to_us("MISSION_SET_CURRENT").set("seq", 9));
  flight.send(to_us("MISSION_CLEAR_ALL"));
  flight.run(0.1);
  EXPECT_EQ(flight.shown_mode(), "AUTO.LOITER") << "there is no mission any more";
}

TEST(Missions, TurnSharplyWithoutRunningAway) {
  MissionFlight flight;
  flight.take_off();
  ASSERT_EQ(flight.upload({item(0, 16, 30.0), item(1, 16, 1.0)}), 0);
  flight.mode(4, 4);
  double furthest = 0.0;
  flight.run(25.0, [&] { furthest = std::max(furthest, flight.body.p_WB.y); });
  EXPECT_LT(furthest, 30.5);
  EXPECT_NEAR(flight.body.p_WB.y, 1.0, 0.3);
}

}  // namespace
}  // namespace tether::autopilot
