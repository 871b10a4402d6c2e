#include "files/named_file.h"

#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::scenario {
namespace {

using testing::HasSubstr;

class NamedFile : public testing::Test {
 protected:
  std::filesystem::path named(ShippedKind kind, const std::string& given) const {
    const toml::Document document =
        toml::Document::parse("\nk = \"" + given + "\"", scratch_.path("own.toml").string());
    return named_file(document.root(), "k", kind);
  }
  std::string refusal(ShippedKind kind, const std::string& given) const {
    const Error error = bad_file_error([&] { named(kind, given); });
    EXPECT_EQ(error.where().line, 2) << error.what();
    EXPECT_EQ(error.subject(), "k") << error.what();
    return error.what();
  }

  const ScratchFolder scratch_;
  const std::filesystem::path shipped_ = std::filesystem::path(TETHER_SOURCE_DIR) / "data";
};

TEST_F(NamedFile, IsAShippedOneOrOneBesideTheFileThatNamesIt) {
  EXPECT_EQ(named(ShippedKind::kWorld, "room"), shipped_ / "worlds/room.sdf");
  EXPECT_EQ(named(ShippedKind::kModel, "hummingbird"), shipped_ / "models/hummingbird/model.sdf");
  const auto court = scratch_.write("court.sdf", "<sdf/>");
  EXPECT_EQ(named(ShippedKind::kWorld, "court.sdf"), court);
  const auto room = scratch_.write("room", "<sdf/>");
  EXPECT_EQ(named(ShippedKind::kWorld, "room"), room);
}

TEST_F(NamedFile, SuggestsWhatMayBeMeant) {
  scratch_.write("court.sdf", "<sdf/>");
  struct Case {
    ShippedKind kind;
    const char *given, *suggestion;
  };
  for (const auto& [kind, given, suggestion] :
       {Case{ShippedKind::kWorld, "rom", "did you mean 'room'?"},
        Case{ShippedKind::kModel, "humingbird", "did you mean 'hummingbird'?"},
        Case{ShippedKind::kEnergy, "humming", "'hummingbird'"},
        Case{ShippedKind::kWorld, "face_anchor", "is a shipped scenario, not a world"},
        Case{ShippedKind::kWorld, "court", "write 'court.sdf'"},
        Case{ShippedKind::kWorld, "curt.sdf", "did you mean 'court.sdf'?"},
        Case{ShippedKind::kWorld, "../worlds/room.sdf", "write \"room\""},
        Case{ShippedKind::kModel, "../../data/models/hummingbird/model.sdf",
             "write \"hummingbird\""}})
    EXPECT_THAT(refusal(kind, given), HasSubstr(suggestion));
}

}  // namespace
}  // namespace tether::scenario
