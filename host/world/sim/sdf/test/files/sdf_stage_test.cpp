#include "files/sdf_stage.h"

#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// How the files of a world find each other, through `load_world`.
namespace tether::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Includes : public ::testing::Test {
 protected:
  std::filesystem::path write_model(const std::string& name, const std::string& content,
                                    const std::string& version = "1.7") const {
    folder_.write(
        "models/" + name + "/model.config",
        "<model><name>" + name + "</name><sdf version='" + version + "'>model.sdf</sdf></model>");
    return folder_.write("models/" + name + "/model.sdf", "<sdf version='" + version +
                                                              "'>\n<model name='" + name + "'>\n" +
                                                              content + "</model></sdf>");
  }
  std::filesystem::path write_world(const std::string& content) const {
    return folder_.write("w.sdf", world_sdf(content));
  }
  static std::string include(const std::string& uri) {
    return "<include>\n<uri>  " + uri + "\n</uri></include>";
  }

  ScratchFolder folder_;
};

TEST_F(Includes, OfIncludedModelsAreFoundLikeThoseOfTheWorld) {
  write_model("inner", "<pose>0 0 3 0 0 0</pose><link name='l'/>");
  write_model("beside", "<link name='l'/>");
  write_model("middle", include("model://inner") + include("../beside"), "1.5");
  write_model("outer", "<static>true</static>" + include("model://middle"));
  const Loaded loaded = load({write_world(include("model://outer")), {}, {}});
  std::vector<std::string> names;
  for (const Model& model : loaded.world.models) names.push_back(model.name);
  EXPECT_THAT(names, ElementsAre("outer", "outer::middle", "outer::middle::inner",
                                 "outer::middle::beside"));
  EXPECT_EQ(loaded.world.models.at(2).X_WM.p, (uav::Vec3{0, 0, 3}));
  EXPECT_EQ(loaded.world.sdf_files.size(), 5u);
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

TEST_F(Includes, OfNothingAreErrorsAtEveryDepth) {
  const auto outer = write_model("outer", "<link name='l'/>\n" + include("model://gone"));
  for (const auto& [file, world] : {std::pair(folder_.path("w.sdf"), include("model://gone")),
                                    std::pair(outer, include("model://outer"))}) {
    ::testing::internal::CaptureStderr();
    const Error error = refusal({write_world(world), {}, {}});
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    expect_error(error, file, file == outer ? 5 : 4, "<include> of 'model://gone'");
  }
  const auto fuel = write_world(include("https://fuel.gazebosim.org/1.0/O/models/M"));
  EXPECT_THAT(refusal({fuel, {}, {}}).what(), HasSubstr("gz fuel download -u \"https://fuel."));
  expect_error(refusal({write_world("<include/>"), {}, {}}), folder_.path("w.sdf"), 3, "<include>");
}

TEST_F(Includes, OfNothingBecomeEmptyModelsUnlessStrict) {
  const auto outer = write_model("outer", "<link name='l'/>\n" + include("model://gone"));
  const auto world = write_world(include("model://outer") +
                                 "<include><uri>https://fuel.gazebosim.org/1.0/O/models/M</uri>"
                                 "<name>shed</name><pose>1 2 3 0 0 0</pose></include>\n"
                                 "<model name='near'><static>true</static>"
                                 "<pose relative_to='shed'>1 0 0 0 0 0</pose></model>");
  const Loaded loaded = load({world, {}, {}});
  EXPECT_THAT(loaded.warnings,
              ::testing::UnorderedElementsAre(
                  is_warning(Consequence::kMissing, world, 5,
                             "<include> of 'https://fuel.gazebosim.org/1.0/O/models/M'"),
                  is_warning(Consequence::kMissing, outer, 5, "<include> of 'model://gone'"),
                  is_warning(Consequence::kBehavesDifferent, outer, 4, "model 'gone_missing1'")));
  EXPECT_EQ(loaded.world.models.back().X_WM.p, (uav::Vec3{2, 2, 3}));
}

TEST_F(Includes, OfNothingHaveTheLinksThatOthersName) {
  const auto world = write_world(
      "<model name='m'><link name='body'/>" + include("model://gone") +
      "<include><uri>model://part</uri><name>p</name></include>\n"
      "<joint name='j' type='fixed'><parent>body</parent><child>gone::base_link</child></joint>"
      "<joint name='k' type='fixed'><parent>body</parent><child>p::arm::hand</child></joint>"
      "</model>");
  std::vector<std::string> links;
  for (const Model& model : load({world, {}, {}}).world.models)
    for (const Link& link : model.links) links.push_back(model.name + "/" + link.name);
  EXPECT_THAT(links, ElementsAre("m/body", "m::gone/base_link", "m::p::arm/hand"));
}

TEST_F(Includes, OfAModelThatMustBeGeneratedSayHow) {
  write_model("drone", "<link name='l'/>");
  std::filesystem::remove(folder_.path("models/drone/model.sdf"));
  folder_.write("models/drone/drone.sdf.jinja", "");
  const auto world = write_world(include("model://drone"));
  EXPECT_THAT(refusal({world, {}, {}}).what(), HasSubstr("'drone.sdf.jinja'"));
  const Loaded loaded = load({world, {}, {}});
  ASSERT_EQ(loaded.warnings.size(), 1u);
  EXPECT_THAT(loaded.warnings[0].message, HasSubstr("'drone.sdf.jinja'"));
}

TEST_F(Includes, OfThemselvesAreRefused) {
  write_model("a", include("model://b"));
  const auto b = write_model("b", "<link name='l'/>" + include("model://a"));
  expect_error(refusal({write_world(include("model://a")), {}, {}}), b, 4,
               "<include> of 'model://a'");
}

TEST_F(Includes, KeepTheirLinesWhateverPrecedesThem) {
  const auto inner = write_model("inner",
                                 "<!-- a\ncomment -->\n<link\n name='l'>\n\n<pose>\n1 2\n"
                                 "3 0 0 0</pose><bogus>a\nb</bogus>\n<bogus/></link>");
  const Loaded loaded = load({write_world(include("model://inner")), {}, {}});
  const auto bogus = [&](int line) {
    return is_warning(Consequence::kBehavesDifferent, inner, line, "<bogus> of link 'l'");
  };
  EXPECT_THAT(loaded.warnings, ElementsAre(bogus(10), bogus(12)));
}

TEST_F(Includes, OfLaterVersionsAreReadAsFarAsKnown) {
  const auto later = write_model("later", "<link name='l'/>", "1.11");
  const Loaded loaded = load({write_world(include("model://later")), {}, {}});
  EXPECT_EQ(loaded.world.models.size(), 1u);
  EXPECT_THAT(loaded.warnings, ElementsAre(is_warning(Consequence::kNoEffect, later, 1, "<sdf>")));
}

}  // namespace
}  // namespace tether::sim
