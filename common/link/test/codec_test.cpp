#include "random_message.h"

#include <gtest/gtest.h>

#include <tether/link/codec.h>

namespace tether::link {
namespace {

std::vector<std::uint8_t> frame_of(const Message& message) {
  Encoder encoder;
  const auto frame = encoder.encode(message);
  return {frame.begin(), frame.end()};
}

/// Every field of every message is in its frame, and encoding is a pure function: if decoding lost
/// or changed a field, encoding what was decoded would give other bytes. The pieces of a frame are
/// the frame, and that of an image is the message's own.
TEST(Codec, RoundTripKeepsEveryFieldWholeAndInPieces) {
  Encoder in_pieces;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Message message = RandomMessage(i).draw();
    ASSERT_TRUE(validate(message).ok()) << i << ": " << validate(message).failure().message;
    const auto frame = frame_of(message);
    const auto result = decode(frame);
    ASSERT_TRUE(result.ok()) << i << ": " << result.failure().message;
    ASSERT_EQ(result->index(), message.index()) << i;
    ASSERT_EQ(frame_of(*result), frame) << i;

    const auto [head, image, tail] = in_pieces.encode_pieces(message);
    std::vector<std::uint8_t> joined(head.begin(), head.end());
    joined.insert(joined.end(), image.begin(), image.end());
    joined.insert(joined.end(), tail.begin(), tail.end());
    ASSERT_EQ(joined, frame) << i;
    const auto* reply = std::get_if<Reply>(&message);
    if (!reply || !reply->sample) continue;
    const auto* camera = std::get_if<uav::CameraSample>(&*reply->sample);
    ASSERT_EQ(image.data(), camera && !camera->rgb.empty() ? camera->rgb.data() : nullptr) << i;
  }
}

template <class T>
T decoded(const T& message) {
  auto result = decode(frame_of(message));
  EXPECT_TRUE(result.ok());
  return std::get<T>(std::move(result).value());
}

// A field that both encoder and decoder left out would survive the round trip above.
TEST(Codec, HelloRequestAndReplyFieldByField) {
  const auto [version, sut, uav, clock, token, concurrent, build_id, process, build] =
      decoded(Hello{9,
                    "sut 1.2",
                    "uav0",
                    {computer::ClockKind::kCpu, 2.5, Duration(7)},
                    "secret",
                    true,
                    "0a",
                    4'000'000'000,
                    {{"argument 1", "3"}, {"library l.so", "0b"}}});
  EXPECT_EQ(std::tie(version, sut, uav, clock, token, concurrent, build_id, process),
            std::tuple(9u, "sut 1.2", "uav0",
                       computer::Clock{computer::ClockKind::kCpu, 2.5, Duration(7)}, "secret", true,
                       "0a", 4'000'000'000u));
  EXPECT_EQ(build, (std::vector<BuildPart>{{"argument 1", "3"}, {"library l.so", "0b"}}));

  const uav::VelocityCommand velocity{{1.0, -2.0, 0.5}, 0.25};
  const std::vector<StageTime> stages{{"detect", Duration(9)}};
  const auto [sequence, issued_at, round_trip, body, computed] =
      decoded(Request{3, from_ns<ExecTime>(40), Duration(5), SetVelocity{velocity}, stages});
  EXPECT_EQ(computed, stages);
  EXPECT_EQ(decoded(Reply{3, from_ns<ExecTime>(40), std::nullopt, stages}).computing, stages);
  EXPECT_EQ(std::tie(sequence, issued_at, round_trip),
            std::tuple(3u, from_ns<ExecTime>(40), Duration(5)));
  EXPECT_EQ(std::get<SetVelocity>(body).command, velocity);

  const std::vector<std::uint8_t> image{1, 2, 3, 4, 5, 6};
  const Reply reply = decoded(
      Reply{3, from_ns<ExecTime>(50), uav::CameraSample{from_ns<SimTime>(45), 8, 2, 1, image}});
  const auto& got = std::get<uav::CameraSample>(*reply.sample);
  EXPECT_EQ(std::tie(reply.resume_at, got.sampled_at, got.index, got.width_px, got.height_px,
                     got.rgb, got.depth_m, got.labels),
            std::tuple(from_ns<ExecTime>(50), from_ns<SimTime>(45), 8u, 2, 1, image,
                       std::vector<float>{}, std::vector<std::uint16_t>{}));
}

TEST(Codec, ImagesHaveDepthsAndLabelsButNotTheTruth) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  uav::CameraSample image{SimTime{}, 1, 2, 1, {}, {1.5F, -kInf}, {0, 65535}};
  image.knows_anchors = true;
  image.seen_anchors = {{"box", 0, 0, 1, 0, 2}};
  const Reply reply = decoded(Reply{3, ExecTime{}, image});
  const auto& got = std::get<uav::CameraSample>(*reply.sample);
  EXPECT_TRUE(got.rgb.empty());
  EXPECT_EQ(got.depth_m, image.depth_m);
  EXPECT_EQ(got.labels, image.labels);
  EXPECT_FALSE(got.knows_anchors);
  EXPECT_TRUE(got.seen_anchors.empty());
}

TEST(Codec, CamerasHaveTheirKindLimitsAndModels) {
  const uav::CameraModel model{640, 480, 1, 2, 3, 4};
  const uav::CameraProperties depth{model, uav::CameraKind::kRgbd, 0.3, 8.0};
  const uav::CameraProperties labels{model, uav::CameraKind::kSegmentation, 0, 0, {"box", ""}};
  for (const auto& sent : {depth, labels}) {
    Welcome welcome;
    welcome.catalogue.sensors = {{"camera", {}, 30.0, sent}};
    const auto sensor = decoded(welcome).catalogue.sensors.at(0);
    const auto got = std::get<uav::CameraProperties>(sensor.properties);
    EXPECT_EQ(std::tie(got.kind, got.min_m, got.max_m, got.models),
              std::tie(sent.kind, sent.min_m, sent.max_m, sent.models));
  }
}

TEST(Codec, WelcomeFieldByField) {
  Welcome welcome;
  welcome.catalogue.sensors = {{"camera",
                                {{1, 2, 3}, {0, 1, 0, 0}},
                                30.0,
                                uav::CameraProperties{{640, 480, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
                                true},
                               {"imu", {}, 0.0, uav::ImuProperties{}},
                               {"down", {}, 10.0, uav::RangeProperties{0.1, 8.0}}};
  welcome.catalogue.anchors = {{"box", uav::AnchorShape::kCylinder, {1, 2, 3}, {0, 0.5, 1}}};
  welcome.free_running = true;
  welcome.catalogue.sensors[0].joints = 1;
  welcome.catalogue.limits.joints = {{"pitch", {1, 2, 3}, {0, 1, 0}, -0.5, 1.5, 2.0}};
  welcome.start = from_ns<ExecTime>(77);
  welcome.real_time_factor = 0.3;

  const Welcome got = decoded(welcome);
  EXPECT_TRUE(got.free_running);
  EXPECT_EQ(got.real_time_factor, 0.3);
  EXPECT_EQ(got.start, welcome.start);
  ASSERT_EQ(got.catalogue.sensors.size(), 3u);
  const auto& [name, X_BS, rate_hz, properties, own_stamps, joints] = got.catalogue.sensors[0];
  EXPECT_TRUE(own_stamps);
  EXPECT_EQ(joints, 1u);
  EXPECT_EQ(got.catalogue.limits.joints, welcome.catalogue.limits.joints);
  EXPECT_EQ(std::tie(name, X_BS, rate_hz),
            std::tuple("camera", welcome.catalogue.sensors[0].X_BS, 30.0));
  const auto& [width, height, fx, fy, cx, cy, k1, k2, k3, p1, p2] =
      std::get<uav::CameraProperties>(properties).model;
  EXPECT_EQ(std::tie(width, height, fx, fy, cx, cy, k1, k2, k3, p1, p2),
            std::tuple(640, 480, 1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_EQ(got.catalogue.sensors[1].kind(), uav::SensorKind::kImu);
  const auto& [min_m, max_m] = std::get<uav::RangeProperties>(got.catalogue.sensors[2].properties);
  EXPECT_EQ(std::tie(min_m, max_m), std::tuple(0.1, 8.0));
  ASSERT_EQ(got.catalogue.anchors.size(), 1u);
  const auto& [anchor, shape, size_m, color_rgb] = got.catalogue.anchors[0];
  EXPECT_EQ(
      std::tie(anchor, shape, size_m, color_rgb),
      std::tuple("box", uav::AnchorShape::kCylinder, uav::Vec3{1, 2, 3}, uav::Vec3{0, 0.5, 1}));
}

TEST(Codec, FrameLengthIsThatOfTheBytesThatFollowAndLimited) {
  using Header = std::array<std::uint8_t, kFrameHeaderBytes>;
  EXPECT_EQ(decode_frame_length(Header{0xe8, 3, 0, 0}, 1000).value(), 1000u);
  for (const Header& header : {Header{0, 0, 0, 0}, {0xe9, 3, 0, 0}, {'G', 'E', 'T', ' '}}) {
    const auto length = decode_frame_length(header, 1000);
    ASSERT_FALSE(length.ok());
    EXPECT_EQ(length.failure().kind, Failure::Kind::kProtocol);
  }
}

TEST(Codec, ReadsFramesAtAnyAddress) {
  const auto frame = frame_of(Hello{1, "sut", "", {}, "token"});
  std::vector<std::uint8_t> shifted(frame.size() + 1);
  std::copy(frame.begin(), frame.end(), shifted.begin() + 1);
  EXPECT_TRUE(decode(std::span(shifted).subspan(1)).ok());
}

/// The decoder rejects what `validate` rejects.
TEST(Codec, RefusesWellFormedFramesWithBadValues) {
  Hello hello;
  hello.clock.factor = std::numeric_limits<double>::quiet_NaN();
  for (const Message& message :
       {Message{hello}, Message{Refusal{static_cast<Refusal::Reason>(99), "x"}},
        Message{Progress{from_ns<ExecTime>(-1)}}}) {
    const auto result = decode(frame_of(message));
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.failure().kind, Failure::Kind::kProtocol);
  }
}

TEST(Codec, NamesClocksAndReasons) {
  EXPECT_EQ(name(Refusal::Reason::kVersion), "version");
  EXPECT_EQ(name(Refusal::Reason::kRunEnded), "run ended");
}

}  // namespace
}  // namespace tether::link
