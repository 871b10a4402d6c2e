#include "support/trials.h"

#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// With scripted execution times a campaign is the same to the byte, however often it is run and
/// however many of its trials run in parallel.
namespace tether::system_test {
namespace {

const std::vector<std::string> kRepeated = {"face/quick/seed-0001", "face/slow/seed-0001",
                                            "face/quick/seed-0002", "face/slow/seed-0002"};

constexpr const char* kConditions = R"([[condition]]
name = "quick"
policy = "conservative_barrier"
clock = "scripted"
computing_ms = 2

[[condition]]
name = "slow"
policy = "conservative_barrier"
clock = "scripted"
computing_ms = 30.5

)";

/// The face-anchor task for tests, under scripted conditions and with a start that differs by seed.
void write_repeated(const std::filesystem::path& folder) {
  const auto file = write_face_scenario(folder, {{"yaw_deg = -12.0",
                                                  "yaw_deg = -12.0\n"
                                                  "yaw_spread_deg = 2.0"}});
  std::string text = read_text(file);
  const auto begin = text.find("[[condition]]");
  text.replace(begin, text.find("[[metric]]") - begin, kConditions);
  write_text(file, text);
  write_text(folder / "campaign.toml",
             "name = \"repeat\"\ntrials = 2\n\n[[scenario]]\nfile = \"face.toml\"\n");
}

class CampaignRepeat : public testing::Test {
 protected:
  CampaignRepeat() { write_repeated(folder_.path()); }

  void run_into(const std::string& out, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> words = {"campaign", folder_ / "campaign.toml", "--out",
                                      folder_ / out};
    words.insert(words.end(), options.begin(), options.end());
    const Output output = run(tether(words));
    ASSERT_EQ(output.code, 0) << output.err;
  }
  std::filesystem::path trial(const std::string& out, const std::string& name) const {
    return folder_ / out / name;
  }
  /// The bytes of result.json up to its last member, which alone may differ.
  std::string result(const std::string& out, const std::string& name) const {
    const std::string text = read_text(trial(out, name) / "result.json");
    EXPECT_EQ(std::prev(nlohmann::ordered_json::parse(text).end()).key(), "this_run");
    return text.substr(0, text.find("\"this_run\": {"));
  }
  void expect_same(const std::string& a, const std::string& b) const {
    for (const std::string& name : kRepeated) {
      EXPECT_EQ(result(a, name), result(b, name)) << name;
      EXPECT_TRUE(timeless_record(trial(a, name)) == timeless_record(trial(b, name)))
          << name << ": the records differ";
    }
  }

  TempFolder folder_;
};

TEST_F(CampaignRepeat, IsTheSameToTheByte) {
  run_into("a");
  run_into("jobs", {"--jobs", "2"});
  expect_same("a", "jobs");

  // Seeds and conditions do make a difference, and the SUT did fly.
  for (std::size_t i = 1; i < kRepeated.size(); ++i)
    EXPECT_NE(read_result(trial("a", kRepeated[0]))["metrics"],
              read_result(trial("a", kRepeated[i]))["metrics"]);
  const auto slow = read_result(trial("a", kRepeated[1]));
  EXPECT_EQ(slow["clock"], "scripted");
  EXPECT_EQ(slow["computing_s"], 0.0305);
  EXPECT_EQ(slow["suts"][0]["clock"], "scripted");
  EXPECT_EQ(slow["end"], "finished");
  EXPECT_TRUE(slow["audit"]["passed"]);
}

}  // namespace
}  // namespace tether::system_test
