#include "conversation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim::protocol {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

SimTime at(std::int64_t ms) {
  return SimTime(milliseconds(ms));
}

/// One UAV, one other body, three past steps, 64x48 pixels.
Open small_open() {
  Open open;
  open.step = milliseconds(1);
  open.uavs = {{"alpha", "", {}, uav::hummingbird()}};
  open.bodies = {{"cart", "body"}};
  open.past_steps = 3;
  open.max_width_px = 64;
  open.max_height_px = 48;
  return open;
}
State state(std::int64_t ms, std::size_t past_steps) {
  State state;
  state.now = at(ms);
  state.bodies.resize(2);
  state.motions.resize(1);
  state.past.resize(2 * past_steps);
  return state;
}
CastRays rays() {
  return {{{}, {}}, 0, {}, {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, 10.0};
}
Render render() {
  Render render;
  render.camera = uav::CameraModel::from_horizontal_fov(64, 48, 1.0);
  render.X_WB.resize(2);
  return render;
}
Picture picture() {
  return {64, 48, std::vector<std::uint8_t>(64 * 48 * 3), 0.0, ""};
}

Conversation after(const std::vector<Request>& requests) {
  Conversation conversation;
  for (const Request& request : requests) {
    const Status status = conversation.check(request);
    EXPECT_TRUE(status.ok()) << status.failure().message;
    conversation.ask(request);
  }
  return conversation;
}

/// `found`: the field or number that the message must have.
template <class Message>
void expect_refused(const Conversation& conversation, const Message& message,
                    const std::string& found) {
  const Status status = conversation.check(message);
  ASSERT_FALSE(status.ok()) << found;
  EXPECT_EQ(status.failure().kind, Failure::Kind::kProtocol);
  EXPECT_THAT(status.failure().message, HasSubstr(found));
}

TEST(Conversation, BeginsWithOneOpenOfThisVersion) {
  const Conversation fresh;
  expect_refused(fresh, Request(Reset{}), "Open");
  Open other = small_open();
  other.version = kVersion + 1;
  expect_refused(fresh, Request(other), "version 2");
  expect_refused(after({small_open()}), Request(small_open()), "Open");
}

TEST(Conversation, AdvancesGoForwardStepByStep) {
  const Conversation advanced = after({small_open(), Advance{at(5), {}}});
  EXPECT_TRUE(advanced.check(Request(Advance{at(5), {{0, {}}}})).ok());
  expect_refused(advanced, Request(Advance{at(4), {}}), "4000000 ns");
  expect_refused(advanced, Request(Advance{at(5) + Duration(1), {}}), "5000001 ns");
  expect_refused(advanced, Request(Advance{at(6), {{1, {}}}}), "Advance.commands");
  expect_refused(advanced, Request(Advance{at(6), {}, {{1, {}}}}), "Advance.setpoints");
  const uav::Setpoint three{.mask = uav::kRotorSpeeds, .rotor_speeds_rad_s = {1, 1, 1}};
  expect_refused(advanced, Request(Advance{at(6), {}, {{0, three}}}), "rotor speeds");
  EXPECT_TRUE(
      after({small_open(), Advance{at(5), {}}, Reset{}}).check(Request(Advance{at(1), {}})).ok());
}

TEST(Conversation, MeasurementsFitTheWorld) {
  const Conversation opened = after({small_open()});
  CastRays few = rays();
  few.X_WB.pop_back();
  expect_refused(opened, Request(few), "CastRays.X_WB");
  Render many = render();
  many.X_WB.push_back({});
  expect_refused(opened, Request(many), "Render.X_WB");
  Render large = render();
  large.camera.width_px = 65;
  expect_refused(opened, Request(large), "65x48");
}

TEST(Conversation, StatesAreThoseRequested) {
  const Conversation advanced = after({small_open(), Advance{at(2), {}}, Advance{at(4), {}}});
  EXPECT_TRUE(advanced.check(Reply(state(4, 2))).ok());
  expect_refused(advanced, Reply(state(5, 2)), "5000000 ns");
  expect_refused(advanced, Reply(state(4, 3)), "State.past");
  State bodies = state(4, 2);
  bodies.bodies.pop_back();
  expect_refused(advanced, Reply(bodies), "State.bodies");
  State motions = state(4, 2);
  motions.motions.clear();
  expect_refused(advanced, Reply(motions), "State.motions");
}

TEST(Conversation, TouchesAreThoseOfTheAdvance) {
  const Conversation advanced = after({small_open(), Advance{at(2), {}}, Advance{at(4), {}}});
  State touching = state(4, 2);
  touching.touches = {{at(2), 0, "wall", 1, 1.0}, {at(3), 0, "wall", 1, 0.0}};
  EXPECT_TRUE(advanced.check(Reply(touching)).ok());
  for (const Touch& wrong :
       {Touch{at(3), 1, "wall", 1, 1.0}, Touch{at(2), 0, "wall", 1, 1.0},
        Touch{at(5), 0, "wall", 1, 1.0}, Touch{at(3) + Duration(1), 0, "wall", 1, 1.0}}) {
    State state = touching;
    state.touches.push_back(wrong);
    expect_refused(advanced, Reply(state), "State.touches");
  }
}

TEST(Conversation, ThePastIsAtMostAsLongAsAnnounced) {
  EXPECT_TRUE(after({small_open(), Advance{at(50), {}}}).check(Reply(state(50, 3))).ok());
  EXPECT_TRUE(after({small_open(), Advance{at(9), {}}, Reset{}}).check(Reply(state(0, 0))).ok());
  EXPECT_TRUE(after({small_open()}).check(Reply(Opened{"", state(0, 0)})).ok());
  expect_refused(after({small_open()}), Reply(Opened{"", state(0, 1)}), "State.past");
}

TEST(Conversation, EveryReplyAnswersItsRequest) {
  const Reply opened = Opened{"", state(0, 0)};
  const std::vector<Reply> replies{opened, state(0, 0), Distances{{1.0, 2.0}}, picture()};
  const std::vector<Request> requests{small_open(), Reset{}, rays(), render()};
  for (std::size_t asked = 0; asked < requests.size(); ++asked) {
    const Conversation conversation =
        asked == 0 ? after({small_open()}) : after({small_open(), requests[asked]});
    for (std::size_t answered = 0; answered < replies.size(); ++answered) {
      EXPECT_EQ(conversation.check(replies[answered]).ok(), asked == answered)
          << asked << " " << answered;
    }
    EXPECT_TRUE(conversation.check(Reply(Failed{"broken"})).ok());
  }
}

TEST(Conversation, MeasurementsHaveTheRequestedSize) {
  expect_refused(after({small_open(), rays()}), Reply(Distances{{1.0}}), "Distances.distance_m");
  Picture small = picture();
  small.height_px = 47;
  expect_refused(after({small_open(), render()}), Reply(small), "64x47");
  Render with_depth = render();
  with_depth.with_depth = true;
  expect_refused(after({small_open(), with_depth}), Reply(picture()), "nearest_depth_m");
}

}  // namespace
}  // namespace tether::sim::protocol
