#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/runner/trial_request.h>

namespace tether::runner {
namespace {

const std::filesystem::path kShipped = std::filesystem::path(TETHER_SOURCE_DIR) / "data";

/// Any request that a command line could ask for.
class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  TrialRequest request() {
    TrialRequest any{.scenario = file()};
    for (std::size_t i = below(4); i > 0; --i) any.settings.push_back({text(), text()});
    if (flag()) any.profile = file();
    for (std::size_t i = below(3); i > 0; --i) any.reading.model_folders.push_back(file());
    any.reading.is_tolerant = flag();
    any.reading.is_strict = flag();
    any.condition = text();
    any.target = target();
    any.simulator = text();
    any.unknown_stages = text();
    for (auto* factor : {&any.slowdown, &any.cpu_time_scale, &any.real_time_factor})
      if (flag()) *factor = std::exp(std::uniform_real_distribution(-9.0, 9.0)(random_));
    any.seed = random_() >> 11;
    any.record_images = flag();
    any.listen = text();
    any.uses_tunnel = flag();
    if (flag()) any.folder = file();
    any.replaces_earlier = flag();
    return any;
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }
  bool flag() { return below(2) == 1; }
  std::string text() {
    constexpr std::string_view kLetters[] = {"a", "Z",      "7", " ", "\"", "\\", "\n",
                                             "=", "[1, 2]", "é", "“", "/",  "'"};
    std::string text;
    for (std::size_t i = below(9); i > 0; --i) text += kLetters[below(std::size(kLetters))];
    return text;
  }
  std::filesystem::path file() { return "/" + text(); }
  TargetChoice target() {
    switch (below(4)) {
      case 0:
        return std::monostate{};
      case 1:
        return std::filesystem::path("/targets/" + std::to_string(below(9)));
      case 2:
        return scenario::SshAddress{"pi@board", static_cast<int>(below(65536))};
      default:
        return WaitForSut{};
    }
  }

  std::mt19937_64 random_;
};

TEST(TrialRequest, IsTheSameAfterItsText) {
  Generator generator(1);
  for (int i = 0; i < 500; ++i) {
    const TrialRequest request = generator.request();
    const std::string text = to_json(request);
    EXPECT_EQ(parse_trial_request(text), request) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
  }
}

TEST(TrialRequest, RefusesATextThatIsNone) {
  const std::string whole = to_json({.scenario = "/s.toml"});
  std::string unknown_type = whole;
  unknown_type.replace(unknown_type.find("\"seed\":1"), 8, "\"seed\":[]");
  for (const std::string& text : {std::string(), std::string("{}"), std::string("[1]"),
                                  whole.substr(0, whole.size() - 1), unknown_type})
    bad_file_error([&] { parse_trial_request(text); });
}

TEST(TrialRequest, OfACampaignsTrialIsThatTrial) {
  scenario::Scenario scenario =
      scenario::load_scenario(kShipped / "scenarios/face_anchor.toml", {{"time_limit_s", "7"}});
  for (const scenario::Condition& own : std::vector(scenario.conditions)) {
    scenario::Condition slowed = own;
    slow_down(slowed, 2.5);
    for (const scenario::Condition& condition : {own, slowed}) {
      const campaign::TrialPlan plan{&scenario, &condition, 9, "/out/one", true};
      const TrialSpec spec = make_trial(request_of(plan));
      EXPECT_EQ(spec.scenario.name, scenario.name);
      EXPECT_EQ(spec.scenario.time_limit, std::chrono::seconds(7));
      EXPECT_TRUE(spec.scenario.record_images);
      EXPECT_EQ(spec.condition.name, condition.name);
      EXPECT_EQ(spec.condition.slowdown, condition.slowdown);
      EXPECT_EQ(computer_of(spec.condition, 0).clock, computer_of(condition, 0).clock);
      EXPECT_EQ(spec.seed, 9u);
      EXPECT_EQ(spec.folder, "/out/one");
      EXPECT_EQ(spec.earlier, EarlierRun::kRefuse);
    }
  }
}

TEST(TrialRequest, LaysTargetSlowdownAndScaleOverTheCondition) {
  const TrialRequest plain{.scenario = kShipped / "scenarios/face_anchor.toml"};
  const std::string first = make_trial(plain).condition.name;
  TrialRequest request = plain;
  request.target = kShipped / "profiles/targets/six_times_slower.toml";
  EXPECT_EQ(make_trial(request).condition.name, "six_times_slower");
  request.condition = first;
  EXPECT_EQ(make_trial(request).condition.name, first + " on six_times_slower");
  request.slowdown = 2.0;
  request.cpu_time_scale = 1.5;
  EXPECT_DOUBLE_EQ(computer_of(make_trial(request).condition, 0).clock.factor, 6.0 * 2.0 * 1.5);
  request = plain;
  request.target = WaitForSut{};
  EXPECT_TRUE(make_trial(request).waits_for_sut);
}

TEST(TrialRequest, RefusesAScaleOfCpuTimeUnderOtherClocks) {
  TrialRequest request{.scenario = kShipped / "scenarios/face_anchor.toml",
                       .target = scenario::SshAddress{"pi@board"},
                       .cpu_time_scale = 2.0};
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { make_trial(request); }).subject(),
            "--cpu-time-scale");
}

TEST(TrialRequest, WithoutAFolderReplacesTheRunOfItsName) {
  TrialRequest request{.scenario = kShipped / "scenarios/face_anchor.toml", .seed = 3};
  const TrialSpec spec = make_trial(request);
  EXPECT_EQ(spec.folder, "out" / campaign::trial_folder("face_anchor", spec.condition.name, 3));
  EXPECT_EQ(spec.earlier, EarlierRun::kReplace);
}

TEST(TrialRequest, RefusesATunnelWithoutABoardAndAWrongAddress) {
  TrialRequest request{.scenario = kShipped / "scenarios/face_anchor.toml", .uses_tunnel = true};
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { make_trial(request); }).subject(), "--tunnel");
  request.target = scenario::SshAddress{"pi@board"};
  EXPECT_TRUE(make_trial(request).uses_tunnel);
  request.listen = "nowhere";
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { make_trial(request); }).subject(), "--listen");
}

}  // namespace
}  // namespace tether::runner
