#include "support/gzserver.h"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

/// What the plugin draws, asked for over the protocol itself.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using std::filesystem::path;
namespace protocol = sim::protocol;

const path kRepository = TETHER_SOURCE_DIR;
constexpr int kWidth_px = 640;
constexpr int kHeight_px = 480;

// Black whatever the light, and however its texture looks.
protocol::VisualMaterial black_material(const std::string& visual, double alpha) {
  protocol::VisualMaterial material;
  material.model = "panes";
  material.link = "link";
  material.visual = visual;
  material.texture = (kRepository / "data/models/textures/brick.png").string();
  material.alpha = alpha;
  return material;
}

protocol::Open open_glass() {
  protocol::Open open;
  open.world_name = "glass";
  open.world_file = (kRepository / "tests/system/data/glass.sdf").string();
  open.step = 1ms;
  open.uavs.push_back({"uav1",
                       "<sdf version='1.6'><model name='uav1'><pose>0 0 1 0 0 0</pose>"
                       "<link name='base_link'></link></model></sdf>",
                       {{0, 0, 1}, {}},
                       uav::hummingbird()});
  open.max_width_px = kWidth_px;
  open.max_height_px = kHeight_px;
  open.materials = {black_material("left", 1.0), black_material("middle", 0.5)};
  return open;
}

// From the UAV's place along x; the upper `height_px` rows of a picture of full size.
protocol::Render view(int height_px) {
  protocol::Render view;
  view.camera.width_px = kWidth_px;
  view.camera.height_px = height_px;
  view.camera.fx_px = view.camera.fy_px = 300.0;
  view.camera.cx_px = 319.5;
  view.camera.cy_px = 239.5;
  view.near_m = 0.1;
  view.far_m = 50.0;
  view.X_WS = {{0, 0, 1}, {}};
  view.X_WB = {view.X_WS};
  view.hidden = 0;
  return view;
}

class GazeboPicturesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = no_gzserver()) GTEST_SKIP() << *why;
    x_.emplace();
    server_.emplace(open_glass().world_file, x_->display());
    connection_ = server_->connect();
    const protocol::Reply opened = answer(open_glass());
    ASSERT_TRUE(std::holds_alternative<protocol::Opened>(opened));
  }

  protocol::Reply answer(const protocol::Request& request) {
    EXPECT_TRUE(connection_->send(request));
    auto reply = connection_->receive_reply(60s);
    if (!reply) throw std::runtime_error(reply.failure().message);
    if (const auto* failed = std::get_if<protocol::Failed>(&*reply))
      ADD_FAILURE() << failed->message;
    return std::move(*reply);
  }
  protocol::Picture draw(const protocol::Render& view) {
    return std::get<protocol::Picture>(answer(view));
  }
  // What gzserver holds of the machine's memory.
  double resident_MB() {
    std::ifstream in("/proc/" + std::to_string(server_->process().pid()) + "/statm");
    double size_pages = 0.0;
    double resident_pages = 0.0;
    in >> size_pages >> resident_pages;
    return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  }

 private:
  std::optional<XServer> x_;
  std::optional<Gzserver> server_;
  std::unique_ptr<protocol::Connection> connection_;
};

int red_at(const protocol::Picture& picture, int u, int v) {
  return picture.rgb[3 * static_cast<std::size_t>(v * picture.width_px + u)];
}

TEST_F(GazeboPicturesTest, SeesThroughWhatIsTransparentTexturedOrNot) {
  const protocol::Picture picture = draw(view(kHeight_px));
  const int wall = red_at(picture, 320, 20);
  EXPECT_GT(wall, 100);
  EXPECT_LT(red_at(picture, 170, 240), 5) << "opaque";
  EXPECT_NEAR(red_at(picture, 320, 240), 0.25 * wall, 3.0) << "textured, through both sides";
  EXPECT_NEAR(red_at(picture, 470, 240), 0.5 * wall, 3.0) << "glass of SDF, through one";
}

TEST_F(GazeboPicturesTest, MeasuresTheDepthOfWhatIsTransparent) {
  protocol::Render towards = view(kHeight_px);
  const std::vector<std::uint8_t> rgb = draw(towards).rgb;
  towards.with_depth = true;
  EXPECT_EQ(draw(towards).rgb, rgb) << "depth changes no colour";
  // Nothing but the middle of one pane, then of the wall.
  towards.camera.width_px = towards.camera.height_px = 20;
  for (const double left_px : {310.0, 460.0}) {
    towards.camera.cx_px = 319.5 - left_px;
    towards.camera.cy_px = 9.5;
    EXPECT_NEAR(draw(towards).nearest_depth_m, 2.0, 1e-3) << left_px;
  }
  towards.camera.cy_px = 219.5;
  EXPECT_NEAR(draw(towards).nearest_depth_m, 4.0, 1e-3);
}

// A rolling shutter asks for bands of whatever height.
TEST_F(GazeboPicturesTest, KeepsNoMemoryOfSizesNorMixesThem) {
  const protocol::Picture whole = draw(view(kHeight_px));
  const protocol::Picture band = draw(view(217));
  EXPECT_EQ(band.rgb.size(), 3U * kWidth_px * 217U);
  EXPECT_TRUE(std::equal(band.rgb.begin(), band.rgb.end(), whole.rgb.begin()));
  const auto draw_heights = [this](int from_px, int to_px) {
    for (int height_px = from_px; height_px < to_px; ++height_px) (void)draw(view(height_px));
  };
  draw_heights(260, 280);
  const double before_MB = resident_MB();
  draw_heights(280, kHeight_px);
  EXPECT_LT(resident_MB() - before_MB, 60.0);
  EXPECT_EQ(draw(view(217)).rgb, band.rgb);
  EXPECT_EQ(draw(view(kHeight_px)).rgb, whole.rgb);
}

}  // namespace
}  // namespace tether::system_test
