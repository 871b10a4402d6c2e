#include "support/installed.h"
#include "support/trials.h"

#include <gtest/gtest.h>

/// examples/own-sut as a user builds it: a copy outside of the tree, against the installed library,
/// by plain compilers; then flown.
namespace tether::system_test {
namespace {

class OwnSut : public testing::TestWithParam<const char*> {
 protected:
  OwnSut() {
    install_client(prefix_);
    std::filesystem::copy(folder_of(prefix_, "face_anchor.toml"), example_,
                          std::filesystem::copy_options::recursive);
    const std::string data = "\"" + std::string(TETHER_SOURCE_DIR) + "/data/";
    const auto file = example_ / "face_anchor.toml";
    write_text(file, substituted(read_text(file),
                                 {{"\"../../data/worlds", data + "worlds"},
                                  {"\"../../data/models", data + "models"},
                                  {"\"../../data/profiles", data + "profiles"},
                                  {"build/face_anchor_cpp\"", std::string(GetParam()) + "\""}}));
  }
  void expect_goal(const std::string& condition = "scripted") const {
    const auto out = folder_ / "out";
    const Output output = run(tether({"run", example_ / "face_anchor.toml", "--condition",
                                      condition, "--quiet", "--out", out}),
                              std::chrono::seconds(100));
    ASSERT_EQ(output.code, 0) << output.err << read_text(out / "sut-uav1.log");
    const auto result = read_result(out);
    EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
    EXPECT_EQ(result["suts"][0]["outcome"], "faces the anchor");
    for (const auto& metric : result["metrics"]) EXPECT_TRUE(metric["value"].is_number()) << metric;
    expect_estimates(read_record(out));
  }
  /// The last one says that it is there.
  static void expect_estimates(const record::Record& record) {
    ASSERT_FALSE(record.annotations.empty());
    const auto last = nlohmann::json::parse(record.annotations.back().message.json);
    EXPECT_TRUE(last["converged"]) << last;
    EXPECT_LE(std::abs(last["bearing_rad"].get<double>()), 0.035);
  }

  const TempFolder folder_;
  const std::filesystem::path prefix_ = folder_ / "installed";
  const std::filesystem::path example_ = folder_ / "own-sut";
};

class OwnSutByCMake : public OwnSut {};
class OwnSutByMake : public OwnSut {};

TEST_P(OwnSutByCMake, FliesToItsGoal) {
  const auto build = example_ / "build";
  output_of({TETHER_CMAKE, "-S", example_, "-B", build, "-DCMAKE_C_COMPILER=gcc",
             "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_PREFIX_PATH=" + prefix_.string()});
  output_of({TETHER_CMAKE, "--build", build});
  expect_goal();
}

TEST_P(OwnSutByMake, FliesToItsGoal) {
  output_of({"make", "CC=gcc", "CXX=g++", GetParam()},
            {{"PKG_CONFIG_PATH", folder_of(prefix_, "tether-client.pc")}}, example_);
  expect_goal();
}

/// The library finds tether-exec by itself; the program is the same.
class OwnSutUnderTetherExec : public OwnSut {};

TEST_P(OwnSutUnderTetherExec, FliesToItsGoal) {
  output_of({"make", "CC=gcc", "CXX=g++", GetParam()},
            {{"PKG_CONFIG_PATH", folder_of(prefix_, "tether-client.pc")}}, example_);
  const auto file = example_ / "face_anchor.toml";
  write_text(file, substituted(read_text(file),
                               {{"\", \"blue_box\"]", "\", \"blue_box\"]\nconcurrent = true"}}));
  expect_goal("board");
}

const auto kPrograms = testing::Values("build/face_anchor_cpp", "build/face_anchor_c");
const auto name_of = [](const auto& program) {
  return std::string(program.param).substr(std::string("build/face_anchor_").size());
};
INSTANTIATE_TEST_SUITE_P(Programs, OwnSutByCMake, kPrograms, name_of);
INSTANTIATE_TEST_SUITE_P(Programs, OwnSutByMake, kPrograms, name_of);
INSTANTIATE_TEST_SUITE_P(Programs, OwnSutUnderTetherExec, kPrograms, name_of);

}  // namespace
}  // namespace tether::system_test
