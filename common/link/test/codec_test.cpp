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
/// or changed a field, encoding what was decoded would give other bytes.
TEST(Codec, RoundTripKeepsEveryField) {
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Message message = RandomMessage(i).draw();
    ASSERT_TRUE(validate(message).ok()) << i << ": " << validate(message).failure().message;
    const auto frame = frame_of(message);
    const auto decoded = decode(frame);
    ASSERT_TRUE(decoded.ok()) << i << ": " << decoded.failure().message;
    ASSERT_EQ(decoded->index(), message.index()) << i;
    ASSERT_EQ(frame_of(*decoded), frame) << i;
  }
}

TEST(Codec, HelloFieldByField) {
  const auto decoded =
      decode(frame_of(Hello{9, "sut 1.2", "uav0", ClockKind::kCpu, 2.5, "secret"}));
  ASSERT_TRUE(decoded.ok());
  const auto& hello = std::get<Hello>(*decoded);
  EXPECT_EQ(hello.protocol_version, 9u);
  EXPECT_EQ(hello.sut, "sut 1.2");
  EXPECT_EQ(hello.uav, "uav0");
  EXPECT_EQ(hello.clock, ClockKind::kCpu);
  EXPECT_EQ(hello.cpu_factor, 2.5);
  EXPECT_EQ(hello.token, "secret");
}

TEST(Codec, WelcomeFieldByField) {
  Welcome welcome;
  welcome.catalogue.uav = "uav0";
  welcome.catalogue.sensors = {{"camera",
                                {{1, 2, 3}, {0, 1, 0, 0}},
                                30.0,
                                uav::CameraProperties{{640, 480, 1, 2, 3, 4, 5, 6, 7, 8, 9}}},
                               {"imu", {}, 0.0, uav::ImuProperties{}},
                               {"down", {}, 10.0, uav::RangeProperties{0.1, 8.0}}};
  welcome.catalogue.anchors = {{"box", uav::AnchorShape::kCylinder, {1, 2, 3}, {0, 0.5, 1}}};
  welcome.free_running = true;
  welcome.start = from_ns<ExecTime>(77);

  const auto decoded = decode(frame_of(welcome));
  ASSERT_TRUE(decoded.ok()) << decoded.failure().message;
  const auto& got = std::get<Welcome>(*decoded);
  ASSERT_EQ(got.catalogue.sensors.size(), 3u);
  const auto& camera = got.catalogue.sensors[0];
  EXPECT_EQ(camera.name, "camera");
  EXPECT_EQ(camera.X_BS, welcome.catalogue.sensors[0].X_BS);
  EXPECT_EQ(camera.rate_hz, 30.0);
  const auto& model = std::get<uav::CameraProperties>(camera.properties).model;
  EXPECT_EQ(model.height_px, 480);
  EXPECT_EQ(model.fx_px, 1.0);
  EXPECT_EQ(model.fy_px, 2.0);
  EXPECT_EQ(model.cx_px, 3.0);
  EXPECT_EQ(model.cy_px, 4.0);
  EXPECT_EQ(model.k1, 5.0);
  EXPECT_EQ(model.k2, 6.0);
  EXPECT_EQ(model.k3, 7.0);
  EXPECT_EQ(model.p1, 8.0);
  EXPECT_EQ(model.p2, 9.0);
  EXPECT_EQ(got.catalogue.sensors[1].kind(), uav::SensorKind::kImu);
  const auto& range = std::get<uav::RangeProperties>(got.catalogue.sensors[2].properties);
  EXPECT_EQ(range.min_m, 0.1);
  EXPECT_EQ(range.max_m, 8.0);
  ASSERT_EQ(got.catalogue.anchors.size(), 1u);
  EXPECT_EQ(got.catalogue.anchors[0].shape, uav::AnchorShape::kCylinder);
  EXPECT_EQ(got.catalogue.anchors[0].size_m, (uav::Vec3{1, 2, 3}));
  EXPECT_EQ(got.catalogue.anchors[0].color_rgb, (uav::Vec3{0, 0.5, 1}));
  EXPECT_TRUE(got.free_running);
  EXPECT_EQ(to_ns(got.start), 77);
}

TEST(Codec, RequestAndReplyFieldByField) {
  const auto request = decode(frame_of(
      Request{3, from_ns<ExecTime>(40), Duration(5), SetVelocity{{{1.0, -2.0, 0.5}, 0.25}}}));
  ASSERT_TRUE(request.ok());
  const auto& r = std::get<Request>(*request);
  EXPECT_EQ(r.sequence, 3u);
  EXPECT_EQ(to_ns(r.issued_at), 40);
  EXPECT_EQ(r.previous_round_trip, Duration(5));
  EXPECT_EQ(std::get<SetVelocity>(r.body).command, (uav::VelocityCommand{{1.0, -2.0, 0.5}, 0.25}));

  const std::vector<std::uint8_t> rgb{1, 2, 3, 4, 5, 6};
  const auto reply = decode(frame_of(
      Reply{3, from_ns<ExecTime>(50), uav::CameraSample{from_ns<SimTime>(45), 8, 2, 1, rgb}}));
  ASSERT_TRUE(reply.ok());
  EXPECT_EQ(to_ns(std::get<Reply>(*reply).resume_at), 50);
  const auto& sample = std::get<uav::CameraSample>(*std::get<Reply>(*reply).sample);
  EXPECT_EQ(to_ns(sample.sampled_at), 45);
  EXPECT_EQ(sample.index, 8u);
  EXPECT_EQ(sample.width_px, 2);
  EXPECT_EQ(sample.height_px, 1);
  EXPECT_EQ(sample.rgb, rgb);
}

TEST(Codec, PiecesAreTheFrameAndPointIntoTheImage) {
  Encoder in_pieces;
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Message message = RandomMessage(i).draw(4);
    const FramePieces pieces = in_pieces.encode_pieces(message);
    std::vector<std::uint8_t> joined;
    for (auto piece : {pieces.head, pieces.image, pieces.tail}) {
      joined.insert(joined.end(), piece.begin(), piece.end());
    }
    ASSERT_EQ(joined, frame_of(message));
    const auto& sample = std::get<Reply>(message).sample;
    if (!sample || !std::holds_alternative<uav::CameraSample>(*sample)) continue;
    ASSERT_EQ(pieces.image.data(), std::get<uav::CameraSample>(*sample).rgb.data());
  }
}

TEST(Codec, LengthIsOfTheBytesThatFollow) {
  const auto frame = frame_of(Progress{from_ns<ExecTime>(5)});
  const auto length = decode_frame_length(
      std::span<const std::uint8_t, kFrameHeaderBytes>(frame.data(), kFrameHeaderBytes), 1000);
  ASSERT_TRUE(length.ok());
  EXPECT_EQ(*length + kFrameHeaderBytes, frame.size());
}

TEST(Codec, RefusesLengthsOutOfBounds) {
  using Header = std::array<std::uint8_t, kFrameHeaderBytes>;
  EXPECT_FALSE(decode_frame_length(Header{0, 0, 0, 0}, 1000).ok());
  EXPECT_FALSE(decode_frame_length(Header{0xe9, 3, 0, 0}, 1000).ok());
  EXPECT_TRUE(decode_frame_length(Header{0xe8, 3, 0, 0}, 1000).ok());
  const auto http = decode_frame_length(Header{'G', 'E', 'T', ' '}, 1000);
  ASSERT_FALSE(http.ok());
  EXPECT_EQ(http.failure().kind, Failure::Kind::kProtocol);
}

TEST(Codec, ReadsFramesAtAnyAddress) {
  const auto frame = frame_of(Hello{1, "sut", "", ClockKind::kWall, 1.0, "token"});
  std::vector<std::uint8_t> shifted(frame.size() + 1);
  std::copy(frame.begin(), frame.end(), shifted.begin() + 1);
  EXPECT_TRUE(decode(std::span(shifted).subspan(1)).ok());
}

/// The decoder checks values, not only structure: what `validate` forbids does not come in either.
TEST(Codec, RefusesWellFormedFramesWithBadValues) {
  Hello hello;
  hello.cpu_factor = std::numeric_limits<double>::quiet_NaN();
  const auto decoded = decode(frame_of(hello));
  ASSERT_FALSE(decoded.ok());
  EXPECT_EQ(decoded.failure().kind, Failure::Kind::kProtocol);
  EXPECT_NE(decoded.failure().message.find("cpu_factor"), std::string::npos);
  EXPECT_FALSE(decode(frame_of(Refusal{static_cast<Refusal::Reason>(99), "x"})).ok());
  EXPECT_FALSE(decode(frame_of(Progress{from_ns<ExecTime>(-1)})).ok());
}

}  // namespace
}  // namespace tether::link
