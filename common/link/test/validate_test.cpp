#include <limits>

#include <gmock/gmock.h>

#include <tether/link/codec.h>

namespace tether::link {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

struct Case {
  std::string field;  // named in the failure; empty: valid
  Message message;
};

void expect(const Case& c) {
  const Status status = validate(c.message);
  ASSERT_EQ(status.ok(), c.field.empty()) << c.field;
  if (status.ok()) return;
  EXPECT_EQ(status.failure().kind, Failure::Kind::kInvalid);
  EXPECT_THAT(status.failure().message, testing::HasSubstr(c.field));
}

Hello hello_with(double factor, std::string sut = "",
                 computer::ClockKind clock = computer::ClockKind::kCpu) {
  return {1, std::move(sut), "", {clock, factor}, ""};
}
Request request_with(decltype(Request::body) body, std::int64_t issued_ns = 0) {
  return {1, from_ns<ExecTime>(issued_ns), Duration(0), std::move(body)};
}
Reply reply_with(uav::Sample sample) {
  return {1, ExecTime{}, std::move(sample)};
}
Reply battery_reply(uav::BatterySample sample) {
  return {.sequence = 1, .resume_at = {}, .sample = {}, .battery = sample};
}
Welcome welcome_with(uav::SensorDescription sensor) {
  Welcome welcome;
  welcome.catalogue.sensors = {std::move(sensor)};
  return welcome;
}
Welcome welcome_with(uav::Anchor anchor) {
  Welcome welcome;
  welcome.catalogue.anchors = {std::move(anchor)};
  return welcome;
}
uav::CameraSample image(int width, int height, std::size_t bytes) {
  return {SimTime{}, 0, width, height, std::vector<std::uint8_t>(bytes)};
}

TEST(Validate, Hello) {
  expect({"", hello_with(1.0)});
  for (const double factor : {0.0, -1.0, kNan, kInf}) expect({"cpu_factor", hello_with(factor)});
  expect({"sut", hello_with(1.0, std::string(257, 'x'))});
  expect({"sut", hello_with(1.0, std::string(1, '\0'))});
  expect({"clock", hello_with(1.0, "", static_cast<computer::ClockKind>(6))});
  Hello backwards = hello_with(1.0);
  backwards.clock.computing = Duration(-1);
  expect({"computing", backwards});
}

TEST(Validate, Requests) {
  expect({"", request_with(ReadSensor{3, true})});
  expect({"sensor", request_with(ReadSensor{5000, false})});
  for (const std::int64_t issued_ns : {std::int64_t{-1}, kMaxTimestampNs})
    expect({"issued_at", request_with(ReadSensor{}, issued_ns)});
  expect({"sequence", Request{}});
  expect({"velocity command", request_with(SetVelocity{{{kNan, 0, 0}, 0}})});
  expect({"velocity command", request_with(SetVelocity{{{0, 0, 0}, 1e9}})});
  const uav::Setpoint here{.mask = uav::kPosition, .in_heading = false};
  expect({"", request_with(SetTrajectory{{{Duration(0), here}, {Duration(1), here}}})});
  expect({"set-point", request_with(SetTrajectory{{{Duration(0), {.mask = uav::kPosition}}}})});
  expect({"q_wb", request_with(SetTrajectory{{{Duration(0), {.q_WB = {2, 0, 0, 0}}}}})});
  expect({"trajectory", request_with(SetTrajectory{})});
  expect({"trajectory", request_with(SetTrajectory{{{Duration(0), here}, {Duration(0), here}}})});
  expect({"setpoints",
          request_with(SetTrajectory{std::vector<uav::TimedSetpoint>(1025, {Duration(0), here})})});
  expect({"until", request_with(Sleep{from_ns<ExecTime>(-5)})});
  expect({"bytes", request_with(SendMessage{"", std::vector<std::uint8_t>(kMaxRadioBytes + 1)})});
  expect({"to", request_with(SendMessage{std::string(kMaxNameBytes + 1, 'u'), {}})});
  expect({"timeout", request_with(ReceiveMessage{Duration(-1)})});
  expect({"most", request_with(ReceiveMessage{Duration(1), {}, kMaxReceived + 1})});
  expect({"arrived_at",
          Reply{.sequence = 1,
                .resume_at = {},
                .sample = {},
                .message = RadioMessage{"u", from_ns<SimTime>(2), from_ns<SimTime>(1), {}}}});
  for (const double charge : {-0.1, 1.1, kNan})
    expect({"charge", battery_reply({{}, 12.0, 1.0, charge})});
  expect({"voltage_v", battery_reply({{}, kInf, 1.0, 0.5})});
  expect({"current_a", battery_reply({{}, 12.0, kNan, 0.5})});
  expect({"sampled_at", battery_reply({from_ns<SimTime>(-1), 12.0, 1.0, 0.5})});
  expect({"", request_with(Finish{true, "facing the anchor", ""})});
  expect({"outcome", request_with(Finish{true, std::string(5000, 'x'), ""})});
  expect({"details", request_with(Finish{true, "", "[1]"})});
  const std::size_t levels = (kMaxJsonBytes - 6) / 2;  // as many lists within each other as fit
  expect({"details",
          request_with(Finish{
              true, "", "{\"a\":" + std::string(levels, '[') + std::string(levels, ']') + "}"})});
  expect({"byte 1, \"]}\"", request_with(Finish{true, "", "{]}"})});
  expect({"byte 1", request_with(Finish{true, "", "{"})});
  expect({"byte 1, \"??[2J\"", request_with(Finish{true, "", "{\xc3\x1b[2J"})});
  Request request = request_with(ReadSensor{});
  request.previous_round_trip = Duration(-1);
  expect({"previous_round_trip", request});
}

TEST(Validate, Samples) {
  expect({"", reply_with(image(2, 3, 18))});
  expect({"image", reply_with(image(2, 3, 17))});
  expect({"image", reply_with(image(2, 3, 21))});
  expect({"image size", reply_with(image(0, 3, 0))});
  expect({"image size", reply_with(image(-2, -3, 18))});
  expect({"image", reply_with(image(1 << 30, 1 << 30, 3))});
  expect({"", reply_with(uav::RangeSample{SimTime{}, 0, kInf})});
  expect({"", reply_with(uav::RangeSample{SimTime{}, 0, -kInf})});
  expect({"range_m", reply_with(uav::RangeSample{SimTime{}, 0, kNan})});
  expect({"", reply_with(uav::ImuSample{})});
  expect({"specific_force", reply_with(uav::ImuSample{SimTime{}, 0, {}, {0, kInf, 0}, {}})});
  expect({"q_ws", reply_with(uav::ImuSample{SimTime{}, 0, {}, {}, {0, 0, 0, 0}})});
  expect({"sampled_at", reply_with(uav::RangeSample{from_ns<SimTime>(-1), 0, 1.0})});
}

TEST(Validate, Catalogue) {
  const uav::CameraProperties camera{{640, 480, 500, 500, 320, 240, 0, 0, 0, 0, 0}};
  expect({"", welcome_with({"camera", {}, 30.0, camera})});
  expect({"'camera': rate_hz", welcome_with({"camera", {}, -1.0, camera})});
  expect({"name", welcome_with({"", {}, 30.0, camera})});
  expect({"x_bs", welcome_with({"camera", {{}, {2, 0, 0, 0}}, 30.0, camera})});
  expect({"focal length", welcome_with({"camera", {}, 1.0, uav::CameraProperties{{1, 1}}})});
  for (const auto& [what, properties] :
       {std::pair{"min_m", uav::CameraProperties{camera.model, uav::CameraKind::kDepth, 2.0, 1.0}},
        std::pair{"kind", uav::CameraProperties{camera.model, static_cast<uav::CameraKind>(4)}},
        std::pair{"model", uav::CameraProperties{camera.model,
                                                 uav::CameraKind::kSegmentation,
                                                 0.0,
                                                 0.0,
                                                 {std::string(257, 'x')}}}}) {
    expect({what, welcome_with({"camera", {}, 30.0, properties})});
  }
  expect({"min_m", welcome_with({"down", {}, 1.0, uav::RangeProperties{3.0, 2.0}})});
  expect({"max_m", welcome_with({"down", {}, 1.0, uav::RangeProperties{0.0, kInf}})});
  expect({"", welcome_with({"box", uav::AnchorShape::kBox, {1, 1, 1}, {0, 0, 1}})});
  expect({"color_rgb", welcome_with({"box", uav::AnchorShape::kBox, {1, 1, 1}, {0, 0, 255}})});
  expect({"size_m", welcome_with({"box", uav::AnchorShape::kBox, {1, -1, 1}, {0, 0, 1}})});
  expect({"shape", welcome_with({"box", static_cast<uav::AnchorShape>(7), {1, 1, 1}, {}})});

  Welcome twice = welcome_with({"camera", {}, 30.0, camera});
  twice.catalogue.sensors.push_back(twice.catalogue.sensors.front());
  expect({"name", twice});
}

std::string nested(std::size_t levels) {
  return "{\"a\":" + std::string(levels - 1, '[') + std::string(levels - 1, ']') + "}";
}

TEST(Validate, LimitsTheDepthOfJson) {
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"\":";
  expect({"", Annotation{ExecTime{}, "roi", nested(60)}});
  for (const std::string& json : {nested(61), nested(400'000), objects})
    expect({"60 levels", Annotation{ExecTime{}, "roi", json}});
}

TEST(Validate, StagesHaveNamesAndTimes) {
  const auto reply_with = [](std::vector<StageTime> times) {
    return Reply{1, ExecTime{}, std::nullopt, std::move(times)};
  };
  expect({"", reply_with({{"detect", Duration(1)}, {"decide", Duration(0)}})});
  expect({"without a name", reply_with({{"", Duration(1)}})});
  expect({"twice", reply_with({{"detect", Duration(1)}, {"detect", Duration(1)}})});
  expect({"negative", reply_with({{"detect", Duration(-1)}})});
  expect({"too many", reply_with(std::vector<StageTime>(kMaxStages + 1, {"a", Duration(0)}))});
  expect({"stages", Request{1, ExecTime{}, Duration(0), Sleep{}, {{"", Duration(0)}}}});
  Hello hello{};
  hello.build_id = "no number";
  expect({"build_id", hello});
  hello.build_id.clear();
  hello.build.assign(kMaxBuildParts, {"argument 1", std::string(kMaxNameBytes, 'a')});
  expect({"", hello});
  hello.build.emplace_back();
  expect({"too many parts", hello});
  hello.build = {{"argument 1", std::string(kMaxNameBytes + 1, 'a')}};
  expect({"build", hello});
}

TEST(Validate, OneWayMessages) {
  expect({"", Annotation{ExecTime{}, "roi", "{}"}});
  expect({"topic", Annotation{ExecTime{}, "", "{}"}});
  expect({"json", Annotation{ExecTime{}, "roi", ""}});
  expect({"reached", Progress{from_ns<ExecTime>(-1)}});
  expect({"reason", Refusal{static_cast<Refusal::Reason>(6), ""}});
}

}  // namespace
}  // namespace tether::link
