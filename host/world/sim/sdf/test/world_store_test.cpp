#include "uav_folder.h"

#include <cstdlib>

#include <sys/stat.h>

#include <tether/base/error.h>
#include <tether/sim/world_parts.h>
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

/// Each load is that of another process.
class Kept : public Store {
 protected:
  Loaded load_now() {
    store_ = WorldStore(cache_, Duration(0));
    return load_again(request_);
  }
  /// The number of the entry's file: another one if it was written again.
  ino_t entry() const {
    struct stat found {};
    for (const auto& file : std::filesystem::directory_iterator(cache_.folder()))
      ::stat(file.path().c_str(), &found);
    return found.st_ino;
  }
  /// Whether a load now is one from the cache.
  bool is_known() {
    const ino_t before = entry();
    load_now();
    return cache_.size().entries == 1 && entry() == before;
  }

  FileCache cache_{folder_.path("cache")};
};

TEST_F(Kept, IsTheSameWorldWithItsWarnings) {
  const Loaded read = load_now();
  request_.uavs[0].p_WB = {1, 2, 3};
  EXPECT_TRUE(is_known());
  const Loaded kept = load_now();
  EXPECT_EQ(kept.warnings, read.warnings);
  EXPECT_FALSE(kept.warnings.empty());
  EXPECT_EQ(kept.world.uavs.at(0).X_WB.p, (uav::Vec3{1, 2, 3}));
  const auto bytes = [](World world) {
    world.uavs.at(0).X_WB = {};
    ByteWriter out;
    out(world);
    return out.take();
  };
  EXPECT_TRUE(bytes(kept.world) == bytes(read.world));
}

TEST_F(Kept, IsReadAgainIfAFileChanged) {
  load_now();
  EXPECT_TRUE(is_known());
  folder_.write("w.sdf", with(world_sdf(""), "name='w'", "name='other'"));
  EXPECT_EQ(load_now().world.name, "other");
  EXPECT_TRUE(is_known());
  folder_.write("uav.sdf", with(kUav, "<update_rate>25", "<update_rate>30"));
  EXPECT_EQ(load_now().world.uavs.at(0).sensors.at(0).update_rate_hz, 30.0);
}

TEST_F(Kept, IsReadAgainIfAModelAppearsInASearchedPlace) {
  request_.world = folder_.write("w.sdf", world_sdf("<include><uri>model://thing</uri></include>"));
  EXPECT_EQ(load_now().world.models.size(), 1U);  // an empty one
  EXPECT_TRUE(is_known());
  const auto write_model = [&](const std::string& place, const std::string& name) {
    folder_.write(place + "/model.config", "<model><sdf>model.sdf</sdf></model>");
    folder_.write(place + "/model.sdf",
                  "<sdf version='1.7'><model name='" + name + "'><link name='l'/></model></sdf>");
  };
  const auto named = [&] { return load_now().world.models.at(0).name; };
  write_model("thing", "far");
  EXPECT_EQ(named(), "far");
  EXPECT_TRUE(is_known());
  write_model("models/thing", "near");
  EXPECT_EQ(named(), "near");
}

TEST_F(Kept, IsThatOfTheRequestAndTheEnvironment) {
  load_now();
  EXPECT_TRUE(is_known());
  ::setenv("SDF_PATH", folder_.path("models").c_str(), 1);
  load_now();
  ::unsetenv("SDF_PATH");
  EXPECT_EQ(cache_.size().entries, 2U);
  request_.options.is_tolerant = true;
  load_now();
  EXPECT_EQ(cache_.size().entries, 3U);
}

TEST_F(Kept, IsReadAgainIfDamaged) {
  load_now();
  const auto file = std::filesystem::directory_iterator(cache_.folder())->path();
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_FALSE(is_known());
  EXPECT_TRUE(is_known());
}

TEST_F(Kept, IsNotAWorldThatJustChangedOrIsRefused) {
  store_ = WorldStore(cache_, std::chrono::hours(1));
  load_again(request_);
  folder_.write("w.sdf", "no XML");
  EXPECT_THROW(load_now(), Error);
  EXPECT_EQ(cache_.size().entries, 0U);
}

}  // namespace
}  // namespace tether::sim
