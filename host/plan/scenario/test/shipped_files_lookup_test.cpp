#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/shipped_files.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

class ShippedFilesLookup : public testing::Test {
 protected:
  const ScratchFolder folder_;
  const std::filesystem::path hover_ =
      folder_.write("data/scenarios/hover.toml", "description = \"Hover for a while\"\n");
  const std::filesystem::path land_ = folder_.write("data/scenarios/land.toml", "");
  const ShippedFiles shipped_{folder_.path("data")};
};

TEST_F(ShippedFilesLookup, FindsAPathOrElseAShippedFileOfThatName) {
  EXPECT_EQ(shipped_.find(ShippedKind::kScenario, "hover"), hover_);
  const auto own = folder_.write("hover", "");
  for (const std::string& path :
       {own.string(), std::string("hover.toml"), std::string("own/hover")})
    EXPECT_EQ(shipped_.find(ShippedKind::kScenario, path), path);
}

TEST_F(ShippedFilesLookup, NamesAFileForACommandLineInAnyFolder) {
  EXPECT_EQ(shipped_.name_of(ShippedKind::kScenario, hover_), "hover");
  const auto own = folder_.write("own/hover.toml", "");
  EXPECT_EQ(shipped_.name_of(ShippedKind::kScenario, own), own.string());
}

TEST_F(ShippedFilesLookup, RefusesANameOfNoFileAndNamesTheNearestOfTheSameKind) {
  const auto refusal = [&](ShippedKind kind, const std::string& given) {
    const Error error = thrown_error(ErrorCode::kUsage, [&] { shipped_.find(kind, given); });
    EXPECT_EQ(error.subject(), given);
    return std::string(error.what());
  };
  EXPECT_THAT(refusal(ShippedKind::kScenario, "hovr"), HasSubstr("'hover'"));
  EXPECT_THAT(refusal(ShippedKind::kScenario, "xyzzy_quux"), Not(HasSubstr("'hover'")));
  EXPECT_THAT(refusal(ShippedKind::kCampaign, "hovr"), Not(HasSubstr("'hover'")));
  EXPECT_THAT(refusal(ShippedKind::kCampaign, "hover"), HasSubstr("tether run hover"));
}

TEST_F(ShippedFilesLookup, RefusesANameIfAFileOfThatKindIsBesideIt) {
  const auto own = folder_.path("own");
  folder_.write("data/worlds/room.sdf", "<sdf/>");
  folder_.write("data/models/uav/model.sdf", "<sdf/>");
  const auto named = [&](ShippedKind kind, const std::string& name) {
    return shipped_.named(kind, name, own);
  };
  folder_.write("own/hover.toml", "trials = 3\n");  // a campaign
  EXPECT_EQ(named(ShippedKind::kScenario, "hover"), hover_);
  EXPECT_EQ(named(ShippedKind::kModel, "uav"), folder_.path("data/models/uav/model.sdf"));
  struct Own {
    ShippedKind kind;
    const char *name, *file, *text;
  };
  for (const Own& beside :
       {Own{ShippedKind::kScenario, "hover", "hover.toml", "world = \"room\"\n"},
        Own{ShippedKind::kWorld, "room", "room.sdf", "<sdf/>"},
        Own{ShippedKind::kModel, "uav", "uav.sdf", "<sdf/>"},
        Own{ShippedKind::kModel, "uav", "uav/model.sdf", "<sdf/>"}}) {
    const auto path = folder_.write(std::string("own/") + beside.file, beside.text);
    const Error error = thrown_error(ErrorCode::kUsage, [&] { named(beside.kind, beside.name); });
    EXPECT_THAT(error.what(), HasSubstr("Write '" + std::string(beside.file) + "'"));
    std::filesystem::remove(path);
  }
}

TEST_F(ShippedFilesLookup, ListsNamesWithDescriptionsInOrder) {
  EXPECT_THAT(shipped_.list(ShippedKind::kScenario),
              ElementsAre(Field(&ShippedFile::name, "hover"), Field(&ShippedFile::name, "land")));
  EXPECT_EQ(shipped_.list(ShippedKind::kScenario)[0].description, "Hover for a while");
  EXPECT_THAT(shipped_.list(ShippedKind::kWorld), IsEmpty());
}

TEST_F(ShippedFilesLookup, DescribesAWorldByTheBeginningOfItsFirstComment) {
  folder_.write(
      "data/worlds/yard.sdf",
      "<?xml version=\"1.0\"?>\n<!--\n  A yard of 4.5 m\n  x 3 m: windy. No roof.\n-->\n");
  folder_.write("data/worlds/bare.sdf", "<sdf/>\n");
  const auto worlds = shipped_.list(ShippedKind::kWorld);
  ASSERT_EQ(worlds.size(), 2u);
  EXPECT_EQ(worlds[0].description, "");
  EXPECT_EQ(worlds[1].description, "A yard of 4.5 m x 3 m");
}

TEST_F(ShippedFilesLookup, DescribesAFileWithoutADescriptionByTheBeginningOfItsFirstComment) {
  folder_.write("data/missions/a.toml", "# Three tasks\n# in one: measure.\nx = 1\n");
  EXPECT_EQ(shipped_.list(ShippedKind::kMission)[0].description, "Three tasks in one");
}

TEST_F(ShippedFilesLookup, BelongsToAProgramInstalledOrInItsBuildFolder) {
  EXPECT_EQ(ShippedFiles::of_program(folder_.path("build/release/bin/tether"))
                .find(ShippedKind::kScenario, "hover"),
            hover_);
  EXPECT_EQ(ShippedFiles::of_program(folder_.path("build/dev/host/x/x_test")).folder(),
            folder_.path("data"));
  const auto installed = folder_.write("usr/share/tether/scenarios/hover.toml", "");
  EXPECT_EQ(ShippedFiles::of_program(folder_.path("usr/bin/tether"))
                .find(ShippedKind::kScenario, "hover"),
            installed);
}

TEST(ShippedFilesOfTheProject, HaveADescriptionEach) {
  const ShippedFiles shipped(std::filesystem::path(TETHER_SOURCE_DIR) / "data");
  for (int i = 0; i < kShippedKinds; ++i) {
    const auto kind = static_cast<ShippedKind>(i);
    EXPECT_FALSE(shipped.list(kind).empty()) << to_text(kind);
    for (const ShippedFile& file : shipped.list(kind)) EXPECT_NE(file.description, "") << file.name;
  }
}

}  // namespace
}  // namespace tether::scenario
