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

TEST_F(ShippedFilesLookup, BelongsToAProgramInstalledOrInItsBuildFolder) {
  EXPECT_EQ(ShippedFiles::of_program(folder_.path("build/release/bin/tether"))
                .find(ShippedKind::kScenario, "hover"),
            hover_);
  const auto installed = folder_.write("usr/share/tether/scenarios/hover.toml", "");
  EXPECT_EQ(ShippedFiles::of_program(folder_.path("usr/bin/tether"))
                .find(ShippedKind::kScenario, "hover"),
            installed);
}

TEST(ShippedFilesOfTheProject, HaveADescriptionEach) {
  const ShippedFiles shipped(std::filesystem::path(TETHER_SOURCE_DIR) / "data");
  for (const auto kind : {ShippedKind::kScenario, ShippedKind::kCampaign, ShippedKind::kWorld,
                          ShippedKind::kProfile, ShippedKind::kTarget}) {
    EXPECT_FALSE(shipped.list(kind).empty()) << to_text(kind);
    for (const ShippedFile& file : shipped.list(kind)) EXPECT_NE(file.description, "") << file.name;
  }
}

}  // namespace
}  // namespace tether::scenario
