#include "support/installed.h"
#include "support/trials.h"

#include <cmath>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

/// examples/own-sut as a user builds it: a copy outside of the tree, against the installed library,
/// by plain compilers; then flown.
namespace tether::system_test {
namespace {

/// Both programs of the example, built in one folder by CMake and in one by make.
class OwnSut : public testing::TestWithParam<const char*> {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    install_client(prefix());
    for (const char* copy : {"by_cmake", "by_make"})
      std::filesystem::copy(folder_of(prefix(), "face_anchor.toml"), *folder_ / copy,
                            std::filesystem::copy_options::recursive);
    const auto example = *folder_ / "by_cmake", build = example / "build";
    output_of({TETHER_CMAKE, "-S", example, "-B", build, "-DCMAKE_C_COMPILER=gcc",
               "-DCMAKE_CXX_COMPILER=g++", "-DCMAKE_PREFIX_PATH=" + prefix().string()});
    output_of({TETHER_CMAKE, "--build", build});
    output_of({"make", "CC=gcc", "CXX=g++", "build/face_anchor_cpp", "build/face_anchor_c"},
              {{"PKG_CONFIG_PATH", folder_of(prefix(), "tether-client.pc")}}, *folder_ / "by_make");
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::filesystem::path prefix() { return *folder_ / "installed"; }

  /// Flies the program that was built so, with changes to its scenario.
  static void expect_goal(const std::string& builder, const std::string& condition = "scripted",
                          const std::vector<Substitution>& changes = {}) {
    const auto example = *folder_ / builder, file = example / "own.toml", out = example / "out";
    const std::string text =
        substituted(read_text(example / "face_anchor.toml"),
                    {{"build/face_anchor_cpp\"", std::string(GetParam()) + "\""}});
    write_text(file, substituted(text, changes));
    const Output output =
        run(tether({"run", file, "--condition", condition, "--quiet", "--force", "--out", out}),
            std::chrono::seconds(100));
    ASSERT_EQ(output.code, 0) << output.err << read_text(out / "sut-uav1.log");
    const auto result = read_result(out);
    EXPECT_TRUE(result["audit"]["passed"]) << result["audit"]["summary"];
    EXPECT_EQ(result["suts"][0]["outcome"], "faces the anchor");
    for (const auto& metric : result["metrics"]) EXPECT_TRUE(metric["value"].is_number()) << metric;
    // The last estimate.
    const auto record = read_record(out);
    ASSERT_FALSE(record.annotations.empty());
    const auto last = nlohmann::json::parse(record.annotations.back().message.json);
    EXPECT_TRUE(last["converged"]) << last;
    EXPECT_LE(std::abs(last["bearing_rad"].get<double>()), 0.035);
  }

  static inline std::unique_ptr<TempFolder> folder_;
};

TEST_P(OwnSut, BuiltByCMakeFliesToItsGoal) {
  expect_goal("by_cmake");
}

/// The library finds tether-exec by itself; the program is the same.
TEST_P(OwnSut, BuiltByMakeFliesToItsGoalUnderTetherExec) {
  expect_goal("by_make", "board", {{"\", \"blue_box\"]", "\", \"blue_box\"]\nconcurrent = true"}});
}

INSTANTIATE_TEST_SUITE_P(
    Programs, OwnSut, testing::Values("build/face_anchor_cpp", "build/face_anchor_c"),
    [](const auto& program) {
      return std::string(program.param).substr(std::strlen("build/face_anchor_"));
    });

}  // namespace
}  // namespace tether::system_test
