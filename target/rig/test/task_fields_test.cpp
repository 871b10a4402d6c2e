#include <set>

#include <gmock/gmock.h>

#include <tether/base/units.h>
#include <tether/rig/mission.h>

namespace tether::rig {
namespace {

using ::testing::HasSubstr;

TaskSpec spec_of(std::string_view task) {
  TaskSpec spec;
  for (const TaskKind& kind : task_kinds()) {
    if (kind.name == task) spec.options = kind.defaults;
  }
  return spec;
}

const Field& named(const std::vector<Field>& fields, std::string_view name) {
  for (const Field& field : fields) {
    if (field.name == name) return field;
  }
  throw std::out_of_range(std::string(name));
}

TEST(TaskFields, AreOfTheTasksInThePapersOrder) {
  std::vector<std::string_view> names;
  for (const TaskKind& kind : task_kinds()) names.push_back(kind.name);
  EXPECT_THAT(names, ::testing::ElementsAre("sensor_characterization", "relative_position",
                                            "face_anchor", "move_forward", "closed_path", "go_to",
                                            "search", "hold", "inspect", "land_on", "land",
                                            "search_pair", "avoid_by_scan", "fly_through_gates"));
}

TEST(TaskFields, HaveUniqueNamesAndDescriptions) {
  for (const TaskKind& kind : task_kinds()) {
    TaskSpec spec = spec_of(kind.name);
    std::set<std::string_view> names;
    for (const Field& field : fields_of(spec)) {
      EXPECT_TRUE(names.insert(field.name).second) << kind.name << ": " << field.name;
      EXPECT_FALSE(field.description.empty()) << field.name;
    }
    EXPECT_TRUE(names.contains("time_limit_s") || kind.name == "hold") << kind.name;
    const std::set<std::string_view> blind = {
        "sensor_characterization", "go_to", "hold", "land", "avoid_by_scan", "fly_through_gates"};
    EXPECT_NE(names.contains("anchor"), blind.contains(kind.name)) << kind.name;
  }
}

TEST(TaskFields, HaveDefaultsThatTheyAllow) {
  for (const TaskKind& kind : task_kinds()) {
    TaskSpec spec = spec_of(kind.name);
    for (const Field& field : fields_of(spec)) {
      if (const auto* number = std::get_if<NumberField>(&field.value)) {
        EXPECT_GE(number->usual, number->least) << kind.name << ": " << field.name;
        EXPECT_LE(number->usual, number->most) << kind.name << ": " << field.name;
      } else if (const auto* integer = std::get_if<IntegerField>(&field.value)) {
        EXPECT_GE(*integer->value, integer->least) << kind.name << ": " << field.name;
        EXPECT_LE(*integer->value, integer->most) << kind.name << ": " << field.name;
      }
    }
  }
}

TEST(TaskFields, WriteToTheSpecInItsOwnUnits) {
  TaskSpec spec = spec_of("face_anchor");
  const std::vector<Field> fields = fields_of(spec);
  const auto& precision = std::get<NumberField>(named(fields, "precision_deg").value);
  EXPECT_NEAR(precision.usual, deg_from_rad(tasks::FaceAnchorOptions{}.precision_rad), 1e-12);
  precision.set(2.0);
  std::get<NumberField>(named(fields, "time_limit_s").value).set(12.5);
  std::get<ChoiceField>(named(fields, "prefilter").value).set(2);
  const auto& options = std::get<tasks::FaceAnchorOptions>(spec.options);
  EXPECT_DOUBLE_EQ(options.precision_rad, rad_from_deg(2.0));
  EXPECT_EQ(options.time_limit, std::chrono::milliseconds(12'500));
  EXPECT_EQ(spec.vision.tracker.prefilter, vision::Prefilter::kMedian);
  EXPECT_EQ(std::get<ChoiceField>(named(fields, "prefilter").value).words[2], "median");
}

}  // namespace
}  // namespace tether::rig
