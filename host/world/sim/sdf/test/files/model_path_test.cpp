#include "files/model_path.h"

#include "sdf_folder.h"

#include <cstdlib>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

const char* const kVariables[] = {
    "HOME",     "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH",
    "SDF_PATH", "GZ_FUEL_CACHE_PATH",   "IGN_FUEL_CACHE_PATH"};

/// A folder of models, without any of the environment's.
class ModelPathTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : kVariables) {
      if (const char* value = std::getenv(name)) before_[name] = value;
      unsetenv(name);
    }
  }
  void TearDown() override {
    for (const char* name : kVariables) {
      unsetenv(name);
      if (const auto value = before_.find(name); value != before_.end())
        setenv(name, value->second.c_str(), 1);
    }
  }
  /// What `uri` leads to, relative to the scratch folder; empty: nothing.
  std::string find(const std::string& uri) const {
    const ModelPath path(folder_.path("worlds/w.sdf"), {folder_.path("shipped")});
    const auto found = path.find(uri, folder_.path("outer/model.sdf"));
    return found ? found->lexically_normal().lexically_relative(folder_.path()).string() : "";
  }

  ScratchFolder folder_;

 private:
  std::map<std::string, std::string> before_;
};

TEST_F(ModelPathTest, SearchesModelsFromTheNearestPlaceToFuelsCache) {
  setenv("HOME", folder_.path().c_str(), 1);
  setenv("GAZEBO_MODEL_PATH", folder_.path("classic").c_str(), 1);
  setenv("IGN_GAZEBO_RESOURCE_PATH", folder_.path("ignition").c_str(), 1);
  setenv("SDF_PATH", folder_.path("sdf").c_str(), 1);
  setenv("GZ_SIM_RESOURCE_PATH", ("/nowhere:" + folder_.path("gz").string()).c_str(), 1);
  // Each is nearer than the one before.
  for (const char* place : {".ignition/fuel/fuel.ignitionrobotics.org/some one/models/thing/1",
                            ".gz/fuel/fuel.gazebosim.org/someone/models/thing/2", "shipped/thing",
                            "sdf/thing", "classic/thing", "ignition/thing", "gz/thing",
                            "worlds/thing", "worlds/models/thing", "outer/models/thing"}) {
    folder_.write(std::string(place) + "/model.sdf", "");
    EXPECT_EQ(find("model://thing"), place);
    EXPECT_EQ(find("model://thing/model.sdf"), std::string(place) + "/model.sdf");
  }
  EXPECT_EQ(find("package://thing"), "outer/models/thing");
  EXPECT_EQ(find("model://other"), "");
}

TEST_F(ModelPathTest, ABareNameIsAFileElseAModel) {
  setenv("GZ_SIM_RESOURCE_PATH", folder_.path("gz").c_str(), 1);
  folder_.write("gz/thing/model.sdf", "");
  folder_.write("gz/a/b/model.sdf", "");
  EXPECT_EQ(find("thing"), "gz/thing");
  EXPECT_EQ(find("a/b"), "gz/a/b");
  folder_.write("worlds/thing", "");
  EXPECT_EQ(find("thing"), "worlds/thing");
}

TEST_F(ModelPathTest, APathMayBeginAboveTheModels) {
  setenv("GAZEBO_MODEL_PATH", folder_.path("elsewhere/models").c_str(), 1);
  for (const char* place : {"elsewhere/models/a/m.dae", "models/a/m.dae"}) {
    std::filesystem::create_directories(folder_.path(place).parent_path());
    folder_.write(place, "");
    EXPECT_EQ(find("file://models/a/m.dae"), place);
  }
}

TEST_F(ModelPathTest, FindsFuelModelsInItsCache) {
  setenv("GZ_FUEL_CACHE_PATH", folder_.path("cache").c_str(), 1);
  const std::string models = "cache/fuel.gazebosim.org/openrobotics/models/";
  for (const char* file : {"ground plane/2/model.sdf", "ground plane/10/model.sdf",
                           "ground plane/10/meshes/a.dae", "ground plane/tip/model.sdf"})
    folder_.write(models + file, "");
  const struct {
    const char* uri;
    std::string found;
  } cases[] = {
      {"https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane", "ground plane/10"},
      {"https://fuel.gazebosim.org/1.0/openrobotics/models/Ground%20Plane/2", "ground plane/2"},
      {"https://fuel.ignitionrobotics.org/1.0/OpenRobotics/models/ground plane/tip",
       "ground plane/10"},
      {"https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane/10/files/meshes/a.dae",
       "ground plane/10/meshes/a.dae"},
      {"https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane/3", ""},
      {"https://fuel.gazebosim.org/1.0/Other/models/Ground Plane", ""},
      {"https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane/10/files/b.dae", ""},
      {"https://example.org/models", ""},
      {"https://", ""},
  };
  for (const auto& given : cases)
    EXPECT_EQ(find(given.uri), given.found.empty() ? "" : models + given.found) << given.uri;
}

TEST_F(ModelPathTest, ResolvesPathsByTheFileThenByTheWorld) {
  folder_.write("worlds/a.dae", "");
  EXPECT_EQ(find("a.dae"), "worlds/a.dae");
  EXPECT_EQ(find("file://" + folder_.path("worlds/a.dae").string()), "worlds/a.dae");
  folder_.write("outer/a.dae", "");
  EXPECT_EQ(find("a.dae"), "outer/a.dae");
  EXPECT_EQ(find("../worlds/a.dae"), "worlds/a.dae");
}

TEST_F(ModelPathTest, SuggestsTheNameThatWasProbablyMeant) {
  folder_.write("outer/models/gate/model.config", "");
  folder_.write("outer/wall.sdf", "");
  folder_.write("outer/textures/planks.png", "");
  const ModelPath path(folder_.path("outer/w.sdf"), {});
  const auto advice = [&](const std::string& uri) {
    return path.advice_on_missing(uri, folder_.path("outer/w.sdf"));
  };
  EXPECT_THAT(advice("model://gaet"), ::testing::HasSubstr("Did you mean 'model://gate'"));
  EXPECT_THAT(advice("model://gaet/meshes/a.dae"), ::testing::HasSubstr("'model://gate'"));
  EXPECT_THAT(advice("model://textures/plank.png"),
              ::testing::HasSubstr("Did you mean 'model://textures/planks.png'"));
  EXPECT_THAT(advice("wal.sdf"), ::testing::HasSubstr("Did you mean 'wall.sdf'"));
  for (const char* uri :
       {"model://sunflower", "model://textures/sunflower.png", "no/such.sdf", "model://"})
    EXPECT_THAT(advice(uri), ::testing::Not(::testing::HasSubstr("Did you mean"))) << uri;
}

TEST_F(ModelPathTest, TakesTheLatestSdfFileOfAModelThatCanBeRead) {
  const auto file_of = [&](const std::string& content) {
    folder_.write("m/model.config", "<model><name>m</name>" + content + "</model>");
    return sdf_file_of(folder_.path("m"), "1.9").filename().string();
  };
  EXPECT_EQ(file_of("<sdf version='1.5'>a.sdf</sdf><sdf version='1.10'>b.sdf</sdf>"
                    "<sdf version='1.6'>c.sdf</sdf>"),
            "c.sdf");
  EXPECT_EQ(file_of("<sdf version='1.10'>b.sdf</sdf>"), "b.sdf");
  EXPECT_EQ(file_of("<sdf>a.sdf</sdf>"), "a.sdf");
  EXPECT_EQ(file_of("<sdf/>"), "");
  EXPECT_EQ(sdf_file_of(folder_.path("none"), "1.9"), "");
}

}  // namespace
}  // namespace tether::sim
