#include "uav_folder.h"

#include <tether/sim_sdf/load_world.h>

namespace tether::sim {
namespace {

class Store : public UavModel {
 protected:
  Loaded load_again(const WorldRequest& request) {
    Loaded loaded;
    loaded.world =
        store_.load(request, [&](const Warning& warning) { loaded.warnings.push_back(warning); });
    return loaded;
  }

  WorldRequest request_ = request(with(kUav, "<update_rate>25", "<unknown/><update_rate>25"));
  WorldStore store_;
};

TEST_F(Store, GivesAWorldAgainWithItsWarningsAndOtherStartPoses) {
  const Loaded first = load_again(request_);
  std::filesystem::remove(request_.world);  // thus from memory
  request_.uavs[0].p_WB = {1, 2, 3};
  request_.uavs[0].yaw_rad = 0.5;
  const Loaded again = load_again(request_);
  EXPECT_FALSE(again.warnings.empty());
  EXPECT_EQ(again.warnings, first.warnings);
  const uav::Pose placed = again.world.uavs.at(0).X_WB;
  EXPECT_EQ(placed.p, (uav::Vec3{1, 2, 3}));
  folder_.write("w.sdf", world_sdf(""));
  EXPECT_EQ(placed.q.z, load(request_).world.uavs.at(0).X_WB.q.z);
}

TEST_F(Store, ReadsAWorldThatIsRequestedOtherwise) {
  load_again(request_);
  const auto rewrite = [&](auto change) {
    WorldRequest other = request_;
    change(other);
    return load_again(other).world.name;
  };
  folder_.write("w.sdf", with(world_sdf(""), "name='w'", "name='other'"));
  folder_.write("uav2.sdf", kUav);
  EXPECT_EQ(rewrite([](auto&) {}), "w");
  EXPECT_EQ(rewrite([](auto& other) { other.uavs[0].name = "b"; }), "other");
  EXPECT_EQ(rewrite([&](auto& other) { other.uavs[0].model = folder_.path("uav2.sdf"); }), "other");
  EXPECT_EQ(rewrite([](auto& other) { other.uavs.clear(); }), "other");
  EXPECT_EQ(rewrite([](auto& other) { other.options.is_tolerant = true; }), "other");
}

}  // namespace
}  // namespace tether::sim
