#include "support/gzserver.h"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/sim_mujoco/mujoco_simulator.h>
#include <tether/sim_remote/remote_simulator.h>
#include <tether/sim_sdf/load_world.h>

/// A real gzserver with Tether's plugin, as the host's half sees it.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using std::filesystem::path;
using testing::AllOf;
using testing::HasSubstr;
namespace protocol = sim::protocol;

const path kSource = TETHER_SOURCE_DIR;

struct Start {
  std::string world;  // file
  uav::Vec3 p_WB;
  double yaw_deg = 0.0;
};
const Start kRoom{(kSource / "data/worlds/room.sdf").string(), {1.2, 0.0, 1.2}, -29.0};
const Start kCorridor{(kSource / "data/worlds/corridor.sdf").string(), {0.0, -0.8, 1.2}, 0.0};
const Start kBlocks{(kSource / "tests/system/data/blocks.sdf").string(), {0.0, 0.0, 1.0}, 0.0};
const Start kGlass{(kSource / "tests/system/data/glass.sdf").string(), {0.0, 0.0, 1.0}, 0.0};

// `has_cameras`: otherwise nobody ever asks for a picture.
sim::World load(const Start& start, bool has_cameras) {
  sim::World world = sim::load_world({start.world,
                                      {{"uav1", kSource / "data/models/hummingbird/model.sdf",
                                        start.p_WB, start.yaw_deg * std::numbers::pi / 180.0}},
                                      {}},
                                     [](const Warning&) {});
  if (!has_cameras) {
    std::erase_if(world.uavs[0].sensors, [](const sim::Sensor& sensor) {
      return sensor.kind() == uav::SensorKind::kCamera;
    });
  }
  return world;
}

std::size_t sensor_of(const sim::Simulator& simulator, uav::SensorKind kind) {
  const auto& sensors = simulator.world().uavs[0].sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i].kind() == kind) return i;
  }
  throw std::runtime_error("the UAV has no such sensor");
}

class GazeboPluginTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = no_gzserver()) GTEST_SKIP() << *why;
  }

  // The simulator in a gzserver of its own, which ends with the test.
  std::unique_ptr<sim::Simulator> gazebo(const Start& start, bool has_cameras) {
    if (has_cameras && !x_) x_.emplace();
    servers_.push_back(std::make_unique<Gzserver>(start.world, has_cameras ? x_->display() : ""));
    return sim::make_remote_simulator(load(start, has_cameras), servers_.back()->connect(), {},
                                      [](const Warning&) {});
  }
  Gzserver& server() { return *servers_.back(); }

 private:
  std::optional<XServer> x_;
  std::vector<std::unique_ptr<Gzserver>> servers_;
};

// Of every kind.
uav::Setpoint command_at(int k) {
  if (k % 10 == 3) return {.mask = uav::kPosition, .in_heading = false, .p_WB_m = {0.5, 0.2, 1.5}};
  if (k % 10 == 4)
    return {.mask = uav::kAttitude | uav::kThrust,
            .q_WB = uav::from_rpy(0.05, -0.05, 0.1),
            .thrust_N = 7.0};
  return uav::to_setpoint(
      {{0.8 * std::sin(0.1 * k), 0.5 * std::cos(0.07 * k), k < 50 ? 0.15 : -0.15},
       0.6 * std::sin(0.05 * k)});
}

// ---- physics ----------------------------------------------------------------------------------

TEST_F(GazeboPluginTest, FliesAsTheEmbeddedSimulatorDoes) {
  const auto gazebo = this->gazebo(kRoom, false);
  const auto embedded = sim::make_mujoco_simulator(load(kRoom, false), [](const auto&) {});
  double worst_m = 0.0;
  for (int k = 1; k <= 100; ++k) {
    for (sim::Simulator* simulator : {gazebo.get(), embedded.get()}) {
      simulator->apply(0, command_at(k));
      simulator->advance_to(SimTime(100ms * k));
    }
    worst_m = std::max(
        worst_m, norm(gazebo->ground_truth(0).body.p_WB - embedded->ground_truth(0).body.p_WB));
  }
  EXPECT_GT(norm(gazebo->ground_truth(0).body.p_WB - kRoom.p_WB), 1.0);
  EXPECT_LT(worst_m, 1e-3);
}

// Where everything was after each 50 ms of a flight into falling blocks.
std::vector<std::vector<double>> flight(sim::Simulator& simulator, bool looks) {
  std::vector<std::vector<double>> states;
  sim::Snapshot snapshot;
  for (int k = 1; k <= 60; ++k) {
    simulator.apply(0, uav::to_setpoint({{1.0, 0.1 * std::sin(0.1 * k), 0.0}, 0.0}));
    simulator.advance_to(SimTime(50ms * k));
    simulator.capture(snapshot);
    states.push_back(snapshot.state);
    if (looks && k % 7 == 0) {
      (void)simulator.measure(snapshot, 0, sensor_of(simulator, uav::SensorKind::kCamera), 0);
    }
  }
  return states;
}

TEST_F(GazeboPluginTest, RepeatsToTheByteAfterAResetInMidFlight) {
  const auto gazebo = this->gazebo(kBlocks, false);
  const auto first = flight(*gazebo, false);
  gazebo->reset(0);
  EXPECT_EQ(flight(*gazebo, false), first);
  gazebo->reset(0);
  gazebo->advance_to(SimTime(1234ms));
  gazebo->reset(0);
  EXPECT_EQ(flight(*gazebo, false), first);
}

TEST_F(GazeboPluginTest, RepeatsToTheByteInANewProcessThatDraws) {
  // What a state holds of the UAV depends on the cameras; the bodies' poses come first in any.
  const auto poses = [](const std::vector<std::vector<double>>& states) {
    std::vector<double> all;
    for (const auto& state : states) all.insert(all.end(), state.begin(), state.begin() + 6 * 7);
    return all;
  };
  const auto blind = flight(*gazebo(kBlocks, false), false);
  EXPECT_EQ(poses(flight(*gazebo(kBlocks, true), true)), poses(blind));
}

// ---- rays -------------------------------------------------------------------------------------

TEST_F(GazeboPluginTest, MeasuresDistancesAsTheyWereToWhatHasMovedSince) {
  const auto gazebo = this->gazebo(kBlocks, false);
  const std::size_t range = sensor_of(*gazebo, uav::SensorKind::kRange);
  std::vector<sim::Snapshot> snapshots(20);
  std::vector<double> then_m;
  const auto measure = [&](const sim::Snapshot& snapshot) {
    return std::get<uav::RangeSample>(gazebo->measure(snapshot, 0, range, 0)).range_m;
  };
  for (int k = 0; k < 20; ++k) {
    gazebo->advance_to(SimTime(50ms * k));
    gazebo->capture(snapshots[static_cast<std::size_t>(k)]);
    then_m.push_back(measure(snapshots[static_cast<std::size_t>(k)]));
  }
  EXPECT_NE(then_m.front(), then_m.back());
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(measure(snapshots[k]), then_m[k]) << k;
}

TEST_F(GazeboPluginTest, MeasuresTheDistancesOfTheEmbeddedSimulator) {
  const auto gazebo = this->gazebo(kRoom, false);
  const auto embedded = sim::make_mujoco_simulator(load(kRoom, false), [](const auto&) {});
  const std::size_t range = sensor_of(*gazebo, uav::SensorKind::kRange);
  for (int k = 1; k <= 20; ++k) {
    std::array<double, 2> range_m{};
    for (std::size_t i = 0; i < 2; ++i) {
      sim::Simulator& simulator = i == 0 ? *gazebo : *embedded;
      simulator.apply(0, uav::to_setpoint({{}, 1.0}));
      simulator.advance_to(SimTime(200ms * k));
      sim::Snapshot snapshot;
      simulator.capture(snapshot);
      range_m[i] = std::get<uav::RangeSample>(simulator.measure(snapshot, 0, range, 0)).range_m;
    }
    EXPECT_TRUE(range_m[0] == range_m[1] || std::abs(range_m[0] - range_m[1]) < 0.005)
        << range_m[0] << " and " << range_m[1] << " m after turn " << k;
  }
}

// ---- pictures ---------------------------------------------------------------------------------

// The saturated blue of the anchors, and nothing else in these worlds.
struct Blue {
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
  double r = 0.0, g = 0.0, b = 0.0;

  explicit Blue(const uav::CameraSample& image) {
    for (int y = 0; y < image.height_px; ++y) {
      for (int x = 0; x < image.width_px; ++x) {
        add(x, y, &image.rgb[3 * static_cast<std::size_t>(y * image.width_px + x)]);
      }
    }
  }
  // Of a colour in which blue is most [degrees].
  double hue_deg() const { return 240.0 + 60.0 * (r - g) / (b - std::min(r, g)); }

 private:
  void add(int x, int y, const std::uint8_t* p) {
    if (p[2] < 80 || p[2] < 2 * p[0] || p[2] < 2 * p[1]) return;
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
    r += p[0];
    g += p[1];
    b += p[2];
  }
};

double mean_difference(const uav::CameraSample& a, const uav::CameraSample& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

uav::CameraSample first_image(sim::Simulator& simulator) {
  sim::Snapshot snapshot;
  simulator.capture(snapshot);
  return std::get<uav::CameraSample>(
      simulator.measure(snapshot, 0, sensor_of(simulator, uav::SensorKind::kCamera), 0));
}

void expect_alike(sim::Simulator& gazebo, const Start& start) {
  const auto embedded = sim::make_mujoco_simulator(load(start, true), [](const auto&) {});
  const uav::CameraSample theirs = first_image(gazebo);
  const uav::CameraSample ours = first_image(*embedded);
  ASSERT_EQ(theirs.rgb.size(), ours.rgb.size());
  const Blue a(theirs);
  const Blue b(ours);
  ASSERT_GE(b.right, b.left);
  EXPECT_NEAR(a.left, b.left, 3);
  EXPECT_NEAR(a.right, b.right, 3);
  EXPECT_NEAR(a.top, b.top, 3);
  EXPECT_NEAR(a.bottom, b.bottom, 3);
  EXPECT_NEAR(a.hue_deg(), b.hue_deg(), 3.0);
  EXPECT_LT(mean_difference(theirs, ours), 5.0);
}

TEST_F(GazeboPluginTest, ShowsTheShippedWorldsAsTheEmbeddedSimulatorDoes) {
  for (const Start& start : {kRoom, kCorridor}) expect_alike(*gazebo(start, true), start);
}

// The mean of 60 × 60 pixels about the middle row.
uav::Vec3 mean_rgb(const uav::CameraSample& image, int left_px) {
  uav::Vec3 sum;
  for (int y = image.height_px / 2 - 30; y < image.height_px / 2 + 30; ++y) {
    for (int x = left_px; x < left_px + 60; ++x) {
      const std::uint8_t* p = &image.rgb[3 * static_cast<std::size_t>(y * image.width_px + x)];
      sum = sum + uav::Vec3{double(p[0]), double(p[1]), double(p[2])};
    }
  }
  return (1.0 / 3600.0) * sum;
}

TEST_F(GazeboPluginTest, BlendsBricksThatAreSeenThroughAsTheEmbeddedSimulatorDoes) {
  const auto gazebo = this->gazebo(kGlass, true);
  const auto embedded = sim::make_mujoco_simulator(load(kGlass, true), [](const auto&) {});
  const uav::CameraSample theirs = first_image(*gazebo);
  const uav::CameraSample ours = first_image(*embedded);
  constexpr int kOpaque_px = 90;
  constexpr int kSeenThrough_px = 290;
  for (const int left_px : {kOpaque_px, kSeenThrough_px}) {
    EXPECT_LT(norm(mean_rgb(theirs, left_px) - mean_rgb(ours, left_px)), 5.0) << left_px;
  }
  EXPECT_GT(norm(mean_rgb(theirs, kSeenThrough_px) - mean_rgb(theirs, kOpaque_px)), 20.0);
}

TEST_F(GazeboPluginTest, DrawsAStateToTheByteWhateverItHasDrawnSince) {
  const auto gazebo = this->gazebo(kBlocks, true);
  const std::size_t camera = sensor_of(*gazebo, uav::SensorKind::kCamera);
  sim::Snapshot early;
  sim::Snapshot late;
  gazebo->capture(early);
  const auto first = std::get<uav::CameraSample>(gazebo->measure(early, 0, camera, 0));
  gazebo->advance_to(SimTime(800ms));
  gazebo->capture(late);
  const auto other = std::get<uav::CameraSample>(gazebo->measure(late, 0, camera, 0));
  EXPECT_GT(mean_difference(other, first), 0.5);
  EXPECT_EQ(std::get<uav::CameraSample>(gazebo->measure(early, 0, camera, 0)).rgb, first.rgb);
}

// ---- ends -------------------------------------------------------------------------------------

protocol::Open open_room() {
  protocol::Open open;
  open.world_name = "room";
  open.world_file = kRoom.world;
  open.step = 1ms;
  open.uavs.push_back({"uav1",
                       "<sdf version='1.6'><model name='uav1'><pose>0 0 1 0 0 0</pose>"
                       "<link name='base_link'/></model></sdf>",
                       {{0, 0, 1}, {}},
                       uav::hummingbird()});
  return open;
}

std::string refusal(protocol::Connection& connection, const protocol::Open& open) {
  EXPECT_TRUE(connection.send(protocol::Request(open)));
  const auto reply = connection.receive_reply(60s);
  if (!reply) return reply.failure().message;
  const auto* failed = std::get_if<protocol::Failed>(&*reply);
  return failed ? failed->message : "not refused";
}

TEST_F(GazeboPluginTest, EndsInOrderWithItsHost) {
  { const auto simulator = gazebo(kRoom, false); }
  const Output output = server().process().wait(20s);
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_FALSE(std::filesystem::exists(server().socket()));
}

TEST_F(GazeboPluginTest, EndsWhenItsHostIsGoneInMidAdvance) {
  Gzserver server(kRoom.world, "");
  {
    const auto connection = server.connect();
    ASSERT_TRUE(connection->send(protocol::Request(open_room())));
    ASSERT_TRUE(connection->receive_reply(60s));
    ASSERT_TRUE(connection->send(protocol::Request(protocol::Advance{SimTime(10h), {}})));
  }
  const Output output = server.process().wait(20s);
  EXPECT_FALSE(output.timed_out);
  EXPECT_EQ(output.code, 1);
  EXPECT_NE(output.err, "");
}

TEST_F(GazeboPluginTest, EndsAtAnInterrupt) {
  Gzserver server(kRoom.world, "");
  const auto connection = server.connect();
  ASSERT_TRUE(connection->send(protocol::Request(open_room())));
  ASSERT_TRUE(connection->receive_reply(60s));
  ASSERT_TRUE(connection->send(protocol::Request(protocol::Advance{SimTime(10h), {}})));
  server.process().signal(SIGINT);
  const auto reply = connection->receive_reply(20s);
  ASSERT_FALSE(reply);
  EXPECT_EQ(reply.failure().kind, tether::Failure::Kind::kDisconnected);
  EXPECT_FALSE(server.process().wait(20s).timed_out);
}

TEST_F(GazeboPluginTest, SaysThatItHasAnotherWorld) {
  Gzserver server(kRoom.world, "");
  const auto connection = server.connect();
  protocol::Open open = open_room();
  open.world_name = "corridor";
  EXPECT_THAT(refusal(*connection, open),
              AllOf(HasSubstr("'room'"), HasSubstr("'corridor'"), HasSubstr(kRoom.world)));
  connection->close();
  EXPECT_EQ(server.process().wait(20s).code, 1);
}

TEST_F(GazeboPluginTest, SaysThatItCannotDraw) {
  Gzserver server(kRoom.world, "");
  const auto connection = server.connect();
  protocol::Open open = open_room();
  open.max_width_px = 64;
  open.max_height_px = 48;
  EXPECT_THAT(refusal(*connection, open), HasSubstr("OpenGL"));
}

}  // namespace
}  // namespace tether::system_test
