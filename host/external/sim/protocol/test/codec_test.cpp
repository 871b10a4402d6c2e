#include "random_message.h"

#include <gtest/gtest.h>

#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

// Encoding what was decoded gives the same bytes: no field was lost. That none is left out is in
// schema_test.cpp.
TEST(Codec, EveryFieldOfEveryMessageArrives) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Request request = RandomMessage(i).request();
    const auto request_frame = frame_of(encoder, request);
    const auto decoded_request = decode_request(request_frame);
    ASSERT_TRUE(decoded_request.ok()) << decoded_request.failure().message;
    ASSERT_EQ(frame_of(encoder, *decoded_request), request_frame);
    const Reply reply = RandomMessage(i).reply();
    const auto reply_frame = frame_of(encoder, reply);
    const auto decoded_reply = decode_reply(reply_frame);
    ASSERT_TRUE(decoded_reply.ok()) << decoded_reply.failure().message;
    ASSERT_EQ(frame_of(encoder, *decoded_reply), reply_frame);
  }
}

// On the wire -1 is none; this one is sent as -2.
TEST(Codec, OtherNegativeIndicesAreRefused) {
  Encoder encoder;
  const CastRays cast{{uav::Pose{}}, 0xfffffffe, {}, {{1.0, 0.0, 0.0}}, 12.5};
  const auto decoded = decode_request(frame_of(encoder, Request(cast)));
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.failure().kind, Failure::Kind::kProtocol);
}

TEST(Codec, PicturesAreSentWithoutACopy) {
  const Reply reply = Picture{64, 48, std::vector<std::uint8_t>(64 * 48 * 3, 9), 1.0, "r"};
  Encoder encoder;
  EXPECT_EQ(encoder.encode(reply).image.data(), std::get<Picture>(reply).rgb.data());
}

TEST(Codec, ARequestIsNotAReply) {
  Encoder encoder;
  const auto request = frame_of(encoder, Request(Reset{}));
  const auto reply = frame_of(encoder, Reply(Failed{}));
  EXPECT_EQ(decode_reply(request).failure().kind, Failure::Kind::kProtocol);
  EXPECT_EQ(decode_request(reply).failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::sim::protocol
