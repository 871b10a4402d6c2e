#include "code_scanner.h"
#include "include_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::layout {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

SourceFile file_of(const std::string& path, const std::string& text) {
  SourceFile file = classify(path);
  file.text = text;
  return file;
}

// ---- the checks find what they are for
// --------------------------------------------------------------------------

TEST(Classify, KnowsLibraryAndRole) {
  EXPECT_EQ(classify("host/sim/mujoco/src/a/b.cpp").library, "sim_mujoco");
  EXPECT_EQ(classify("host/sim/include/tether/sim/world.h").library, "sim");
  EXPECT_EQ(classify("host/sim/include/tether/sim/world.h").role, Role::kPublicHeader);
  EXPECT_EQ(classify("common/base/test/time_test.cpp").role, Role::kTest);
  EXPECT_EQ(classify("common/base/testing/include/tether/base_testing/c.h").role, Role::kTesting);
  EXPECT_EQ(classify("apps/tether/main.cpp").role, Role::kProgram);
  EXPECT_EQ(classify("apps/tether-sut/test/mission_test.cpp").role, Role::kTest);
  EXPECT_EQ(classify("bench/link_bench.cpp").role, Role::kOther);
}

TEST(Arrows, PlantedBreachesAreFound) {
  EXPECT_THAT(check_arrows({file_of("target/tasks/src/a.cpp", "#include <tether/sim/world.h>\n")}),
              ElementsAre(HasSubstr("target/tasks/src/a.cpp:1: 'tasks' may not include 'sim'")));
  EXPECT_THAT(check_arrows({file_of("host/audit/src/a.cpp",
                                    "#include <tether/sync/barrier_synchronizer.h>\n")}),
              ElementsAre(HasSubstr("'audit' may not include 'sync'")));
  EXPECT_THAT(check_arrows({file_of("target/tasks/test/a_test.cpp",
                                    "#include <tether/coordinator/session.h>\n")}),
              ElementsAre(HasSubstr("'tasks' may not include 'coordinator'")));
  EXPECT_THAT(check_arrows({file_of("target/client/src/a.cpp", "#include <tether/client.hpp>\n")}),
              ElementsAre(HasSubstr("'client' may not include 'client_c_api'")));
  EXPECT_THAT(check_arrows({file_of("host/novel/src/a.cpp", "#include <tether/base/time.h>\n")}),
              ElementsAre(HasSubstr("no line in the table")));
}

TEST(Arrows, FakesAreForTestsOnly) {
  const std::string text = "#include <tether/sim_testing/fake_simulator.h>\n";
  EXPECT_THAT(check_arrows({file_of("host/coordinator/src/a.cpp", text)}),
              ElementsAre(HasSubstr("fake")));
  EXPECT_THAT(check_arrows({file_of("host/coordinator/test/a_test.cpp", text)}), IsEmpty());
  EXPECT_THAT(check_arrows({file_of("apps/tether/src/a.cpp", text)}),
              ElementsAre(HasSubstr("fake")));
  EXPECT_THAT(check_arrows({file_of("apps/tether/test/a_test.cpp", text)}), IsEmpty());
}

TEST(Cycles, APlantedCycleIsFound) {
  EXPECT_THAT(check_cycles({file_of("common/base/src/a.cpp", "#include <tether/link/codec.h>\n"),
                            file_of("common/link/src/b.cpp", "#include <tether/uav/math.h>\n"),
                            file_of("common/uav/src/c.cpp", "#include <tether/base/time.h>\n")}),
              ElementsAre("cycle: base -> link -> uav -> base"));
}

TEST(PublicHeaders, PlantedBreachesAreFound) {
  const std::string path = "common/link/include/tether/link/a.h";
  EXPECT_THAT(check_public_headers({file_of(path, "#pragma once\n#include <fmt/format.h>\n")}),
              ElementsAre(HasSubstr("third-party")));
  EXPECT_THAT(check_public_headers({file_of(path, "#pragma once\n#include <Eigen/Core>\n")}),
              ElementsAre(HasSubstr("third-party")));
  EXPECT_THAT(check_public_headers({file_of(path, "#pragma once\n#include \"b.h\"\n")}),
              ElementsAre(HasSubstr("quotes")));
  EXPECT_THAT(check_public_headers({file_of(path, "#include <vector>\n")}),
              ElementsAre(HasSubstr("#pragma once")));
  EXPECT_THAT(check_public_headers({file_of("common/link/src/a.cpp", "#include <fmt/format.h>\n")}),
              IsEmpty());
}

TEST(PrivateHeaders, PlantedBreachesAreFound) {
  const SourceFile header = file_of("common/link/src/frame.h", "#pragma once\n");
  EXPECT_THAT(
      check_private_headers({header,
                             file_of("common/link/src/a.cpp",
                                     "#include \"frame.h\"\n#include \"link_generated.h\"\n"),
                             file_of("common/link/test/a_test.cpp", "#include \"frame.h\"\n")}),
      IsEmpty());
  EXPECT_THAT(
      check_private_headers({header, file_of("target/client/src/a.cpp", "#include \"frame.h\"\n")}),
      ElementsAre(HasSubstr("is no file of this folder")));
  EXPECT_THAT(check_private_headers({header, file_of("target/client/src/a.cpp",
                                                     "#include \"../../link/src/frame.h\"\n")}),
              ElementsAre(HasSubstr("climbs")));
  EXPECT_THAT(check_private_headers({header, file_of("bench/a.cpp", "#include \"frame.h\"\n")}),
              IsEmpty());
}

TEST(Sync, PlantedBreachesAreFound) {
  const std::string path = "host/sync/src/a.cpp";
  EXPECT_THAT(check_sync_is_pure({file_of(path, "#include <thread>\n")}),
              ElementsAre(HasSubstr("<thread>")));
  EXPECT_THAT(check_sync_is_pure({file_of(path, "#include <spdlog/spdlog.h>\n")}),
              ElementsAre(HasSubstr("spdlog")));
  EXPECT_THAT(check_sync_is_pure({file_of(path, "auto t = std::chrono::steady_clock::now();\n")}),
              ElementsAre(HasSubstr("steady_clock")));
  EXPECT_THAT(check_sync_is_pure({file_of(path, "// no steady_clock here\n#include <vector>\n")}),
              IsEmpty());
}

TEST(Coordinator, APlantedNameIsFound) {
  EXPECT_THAT(check_coordinator_is_neutral({file_of("host/coordinator/src/a.cpp",
                                                    "\n auto s = make_mujoco_simulator();\n")}),
              ElementsAre(HasSubstr("a.cpp:2")));
}

TEST(Randomness, APlantedGeneratorIsFound) {
  EXPECT_THAT(check_randomness({file_of("common/uav/src/a.cpp", "std::mt19937 g;\n")}),
              ElementsAre(HasSubstr("mt19937")));
  EXPECT_THAT(check_randomness({file_of("common/uav/test/a_test.cpp", "std::mt19937 g(1);\n")}),
              IsEmpty());
}

// ---- the repository keeps the rules
// -----------------------------------------------------------------------------

class Repository : public testing::Test {
 protected:
  static void SetUpTestSuite() { files_ = read_sources(TETHER_SOURCE_DIR); }
  static void TearDownTestSuite() { files_.clear(); }
  inline static std::vector<SourceFile> files_;
};

TEST_F(Repository, IsRead) {
  std::size_t product = 0;
  std::size_t found = 0;
  for (const SourceFile& file : files_) {
    product += file.is_product() ? 1U : 0U;
    found += includes(file.text).size();
  }
  EXPECT_GT(product, 30u);
  EXPECT_GT(found, 100u);
}

TEST_F(Repository, FollowsTheArrows) {
  EXPECT_EQ(one_per_line(check_arrows(files_)), "");
}
TEST_F(Repository, HasNoCycles) {
  EXPECT_EQ(one_per_line(check_cycles(files_)), "");
}
TEST_F(Repository, KeepsThirdPartiesOutOfPublicHeaders) {
  EXPECT_EQ(one_per_line(check_public_headers(files_)), "");
}
TEST_F(Repository, KeepsPrivateHeadersPrivate) {
  EXPECT_EQ(one_per_line(check_private_headers(files_)), "");
}
TEST_F(Repository, KeepsSyncPure) {
  EXPECT_EQ(one_per_line(check_sync_is_pure(files_)), "");
}
TEST_F(Repository, KeepsTheCoordinatorNeutral) {
  EXPECT_EQ(one_per_line(check_coordinator_is_neutral(files_)), "");
}
TEST_F(Repository, DrawsRandomNumbersByKey) {
  EXPECT_EQ(one_per_line(check_randomness(files_)), "");
}

}  // namespace
}  // namespace tether::layout
