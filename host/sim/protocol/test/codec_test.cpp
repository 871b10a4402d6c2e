#include "random_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_protocol/codec.h>

namespace tether::sim::protocol {
namespace {

template <class Member>
Member there_and_back(const Member& message) {
  Encoder encoder;
  if constexpr (std::is_constructible_v<Request, Member>) {
    return std::get<Member>(decode_request(frame_of(encoder, Request(message))).value());
  } else {
    return std::get<Member>(decode_reply(frame_of(encoder, Reply(message))).value());
  }
}

uav::MultirotorParameters airframe_of_different_numbers() {
  uav::MultirotorParameters p;
  p.mass_kg = 1.0;
  p.inertia_kg_m2 = {2.0, 3.0, 4.0};
  p.rotors = {{{5.0, 6.0, 7.0}, -1}, {{8.0, 9.0, 10.0}, 1}};
  p.thrust_coefficient = 11.0;
  p.moment_coefficient_m = 12.0;
  p.drag_coefficient = 13.0;
  p.linear_drag_N_s_m = 14.0;
  p.max_rotor_speed_rad_s = 15.0;
  p.time_constant_up_s = 16.0;
  p.time_constant_down_s = 17.0;
  p.max_tilt_rad = 18.0;
  p.max_horizontal_speed_m_s = 19.0;
  p.max_vertical_speed_m_s = 20.0;
  p.max_yaw_rate_rad_s = 21.0;
  p.max_acceleration_m_s2 = 22.0;
  p.max_yaw_acceleration_rad_s2 = 23.0;
  return p;
}

void expect_same(const uav::MultirotorParameters& a, const uav::MultirotorParameters& b) {
  const auto numbers = [](const uav::MultirotorParameters& p) {
    std::vector<double> out{p.mass_kg,
                            p.inertia_kg_m2.x,
                            p.inertia_kg_m2.y,
                            p.inertia_kg_m2.z,
                            p.thrust_coefficient,
                            p.moment_coefficient_m,
                            p.drag_coefficient,
                            p.linear_drag_N_s_m,
                            p.max_rotor_speed_rad_s,
                            p.time_constant_up_s,
                            p.time_constant_down_s,
                            p.max_tilt_rad,
                            p.max_horizontal_speed_m_s,
                            p.max_vertical_speed_m_s,
                            p.max_yaw_rate_rad_s,
                            p.max_acceleration_m_s2,
                            p.max_yaw_acceleration_rad_s2};
    for (const auto& r : p.rotors) {
      out.insert(out.end(), {r.p_BR.x, r.p_BR.y, r.p_BR.z, static_cast<double>(r.direction)});
    }
    return out;
  };
  EXPECT_EQ(numbers(a), numbers(b));
}

const uav::Pose kPose{{1.0, 2.0, 3.0}, {0.5, -0.5, 0.5, -0.5}};
const uav::Pose kOther{{-4.0, 5.0, 0.25}, {0.0, 0.0, 0.6, 0.8}};

TEST(Codec, OpenArrivesAsItWasSent) {
  Open open{7,
            "corridor",
            "/worlds/corridor.sdf",
            9.75,
            std::chrono::microseconds(500),
            {{"alpha", "<sdf/>", kPose, airframe_of_different_numbers()}},
            {{"cart::body", "wheel"}},
            12,
            640,
            480,
            {}};
  open.looks = {{"wall",
                 "link",
                 "front",
                 {0.1, 0.2, 0.3},
                 {0.4, 0.5, 0.6},
                 {0.7, 0.8, 0.9},
                 {1.0, 0.0, 0.05},
                 "/textures/brick.png",
                 1.5,
                 2.5}};
  const Open back = there_and_back(open);
  EXPECT_EQ(back.version, 7u);
  EXPECT_EQ(back.world_name, "corridor");
  EXPECT_EQ(back.world_file, "/worlds/corridor.sdf");
  EXPECT_EQ(back.gravity_m_s2, 9.75);
  EXPECT_EQ(back.step, std::chrono::microseconds(500));
  EXPECT_EQ(back.past_steps, 12u);
  EXPECT_EQ(back.max_width_px, 640);
  EXPECT_EQ(back.max_height_px, 480);
  ASSERT_EQ(back.uavs.size(), 1u);
  EXPECT_EQ(back.uavs[0].name, "alpha");
  EXPECT_EQ(back.uavs[0].sdf, "<sdf/>");
  EXPECT_EQ(back.uavs[0].X_WB, kPose);
  expect_same(back.uavs[0].airframe, open.uavs[0].airframe);
  ASSERT_EQ(back.bodies.size(), 1u);
  EXPECT_EQ(back.bodies[0].model, "cart::body");
  EXPECT_EQ(back.bodies[0].link, "wheel");
}

TEST(Codec, LooksArriveAsTheyWereSent) {
  Open open;
  open.step = std::chrono::milliseconds(1);
  const Look look{"wall",
                  "link",
                  "front",
                  {0.1, 0.2, 0.3},
                  {0.4, 0.5, 0.6},
                  {0.7, 0.8, 0.9},
                  {1.0, 0.0, 0.05},
                  "/textures/brick.png",
                  1.5,
                  2.5,
                  0.25};
  open.looks = {look};
  const Look back = there_and_back(open).looks.at(0);
  EXPECT_EQ(back.model, look.model);
  EXPECT_EQ(back.link, look.link);
  EXPECT_EQ(back.visual, look.visual);
  EXPECT_EQ(back.ambient_rgb, look.ambient_rgb);
  EXPECT_EQ(back.diffuse_rgb, look.diffuse_rgb);
  EXPECT_EQ(back.specular_rgb, look.specular_rgb);
  EXPECT_EQ(back.emissive_rgb, look.emissive_rgb);
  EXPECT_EQ(back.texture, look.texture);
  EXPECT_EQ(back.texture_repeat_x, look.texture_repeat_x);
  EXPECT_EQ(back.texture_repeat_y, look.texture_repeat_y);
  EXPECT_EQ(back.alpha, look.alpha);
}

TEST(Codec, ResetAndAdvanceArriveAsTheyWereSent) {
  EXPECT_EQ(there_and_back(Reset{0xfedcba9876543210}).seed, 0xfedcba9876543210);
  const uav::VelocityCommand command{{1.0, -2.0, 3.0}, -0.5};
  const Advance back =
      there_and_back(Advance{from_ns<SimTime>(1'234'567'890'123), {{3, command}, {0, {}}}});
  EXPECT_EQ(to_ns(back.to), 1'234'567'890'123);
  ASSERT_EQ(back.commands.size(), 2u);
  EXPECT_EQ(back.commands[0].uav, 3u);
  EXPECT_EQ(back.commands[0].command, command);
  EXPECT_EQ(back.commands[1].uav, 0u);
}

TEST(Codec, RaysArriveAsTheyWereSent) {
  const std::vector<uav::Vec3> rays{{1.0, 0.0, 0.0}, {0.0, 0.6, -0.8}};
  const CastRays back = there_and_back(CastRays{{kPose, kOther}, 1, kOther, rays, 12.5});
  EXPECT_EQ(back.X_WB, (std::vector{kPose, kOther}));
  EXPECT_EQ(back.carrier, 1u);
  EXPECT_EQ(back.X_WS, kOther);
  EXPECT_EQ(back.rays_S, rays);
  EXPECT_EQ(back.max_m, 12.5);
  EXPECT_FALSE(there_and_back(CastRays{{}, {}, kOther, rays, 1.0}).carrier);
}

// On the wire -1 is none; this one comes as -2.
TEST(Codec, OtherNegativeIndicesAreRefused) {
  Encoder encoder;
  const CastRays cast{{kPose}, 0xfffffffe, kOther, {{1.0, 0.0, 0.0}}, 12.5};
  const auto decoded = decode_request(frame_of(encoder, Request(cast)));
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.failure().message, testing::HasSubstr("carrier"));
}

TEST(Codec, RenderArrivesAsItWasSent) {
  Render render;
  render.camera = {320, 200, 250.5, 250.5, -10.25, 1000.5};
  render.near_m = 0.125;
  render.far_m = 55.0;
  render.X_WS = kPose;
  render.X_WB = {kOther};
  render.hidden = 0;
  render.with_depth = true;
  const Render back = there_and_back(render);
  EXPECT_EQ(back.camera.width_px, 320);
  EXPECT_EQ(back.camera.height_px, 200);
  EXPECT_EQ(back.camera.fx_px, 250.5);
  EXPECT_EQ(back.camera.fy_px, 250.5);
  EXPECT_EQ(back.camera.cx_px, -10.25);
  EXPECT_EQ(back.camera.cy_px, 1000.5);
  EXPECT_EQ(back.near_m, 0.125);
  EXPECT_EQ(back.far_m, 55.0);
  EXPECT_EQ(back.X_WS, kPose);
  EXPECT_EQ(back.X_WB, std::vector{kOther});
  EXPECT_EQ(back.hidden, 0u);
  EXPECT_TRUE(back.with_depth);
}

TEST(Codec, StatesArriveAsTheyWereSent) {
  const uav::BodyState body{{1.0, 2.0, 3.0}, kOther.q, {4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}};
  const State state{from_ns<SimTime>(5'000'000),
                    {body},
                    {{{10.0, 11.0, 12.0}, {13.0, 14.0, 15.0}}},
                    {kPose, kOther}};
  const Opened back = there_and_back(Opened{"Simulator 1.0", state});
  EXPECT_EQ(back.description, "Simulator 1.0");
  EXPECT_EQ(back.state.now, state.now);
  ASSERT_EQ(back.state.bodies.size(), 1u);
  EXPECT_EQ(back.state.bodies[0].p_WB, body.p_WB);
  EXPECT_EQ(back.state.bodies[0].q_WB, body.q_WB);
  EXPECT_EQ(back.state.bodies[0].v_WB, body.v_WB);
  EXPECT_EQ(back.state.bodies[0].w_WB_B, body.w_WB_B);
  ASSERT_EQ(back.state.motions.size(), 1u);
  EXPECT_EQ(back.state.motions[0].a_WB_W, state.motions[0].a_WB_W);
  EXPECT_EQ(back.state.motions[0].alpha_WB_B, state.motions[0].alpha_WB_B);
  EXPECT_EQ(back.state.past, state.past);
  EXPECT_EQ(there_and_back(state).past, state.past);
}

TEST(Codec, MeasurementsArriveAsTheyWereSent) {
  const std::vector<double> distances{1.5, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_EQ(there_and_back(Distances{distances}).distance_m, distances);
  const Picture picture{2, 1, {1, 2, 3, 4, 5, 6}, 0.75, "llvmpipe"};
  const Picture back = there_and_back(picture);
  EXPECT_EQ(back.width_px, 2);
  EXPECT_EQ(back.height_px, 1);
  EXPECT_EQ(back.rgb, picture.rgb);
  EXPECT_EQ(back.nearest_depth_m, 0.75);
  EXPECT_EQ(back.renderer, "llvmpipe");
  EXPECT_EQ(there_and_back(Failed{"no GL"}).message, "no GL");
}

TEST(Codec, APictureGoesOutWithoutBeingCopied) {
  const Reply reply = Picture{64, 48, std::vector<std::uint8_t>(64 * 48 * 3, 9), 1.0, "r"};
  Encoder encoder;
  EXPECT_EQ(encoder.encode(reply).image.data(), std::get<Picture>(reply).rgb.data());
}

TEST(Codec, EveryMessageComesBackTheSame) {
  Encoder encoder;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const auto request = frame_of(encoder, RandomMessage(i).request());
    const auto decoded_request = decode_request(request);
    ASSERT_TRUE(decoded_request.ok()) << decoded_request.failure().message;
    ASSERT_EQ(frame_of(encoder, *decoded_request), request);
    const auto reply = frame_of(encoder, RandomMessage(i).reply());
    const auto decoded_reply = decode_reply(reply);
    ASSERT_TRUE(decoded_reply.ok()) << decoded_reply.failure().message;
    ASSERT_EQ(frame_of(encoder, *decoded_reply), reply);
  }
}

TEST(Codec, ARequestIsNoReply) {
  Encoder encoder;
  const auto request = frame_of(encoder, Request(Reset{}));
  const auto reply = frame_of(encoder, Reply(Failed{}));
  EXPECT_EQ(decode_reply(request).failure().kind, Failure::Kind::kProtocol);
  EXPECT_EQ(decode_request(reply).failure().kind, Failure::Kind::kProtocol);
}

}  // namespace
}  // namespace tether::sim::protocol
