#include "support/trials.h"

#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// The target's programs for 64-bit ARM (scripts/build-arm64), under an emulator: a machine of
/// another architecture, slow, and slow in another way than a factor.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const std::filesystem::path kSources = TETHER_SOURCE_DIR;

/// The arguments of a program of this build, for the same one of the other architecture.
std::vector<std::string> emulated(std::vector<std::string> arguments) {
  const auto program =
      kSources / "build/arm64/bin" / std::filesystem::path(arguments.front()).filename();
  arguments.front() = program;
  arguments.insert(arguments.begin(), {"qemu-aarch64", "-L", kSources / "build/sysroot-arm64"});
  return arguments;
}

/// Without what the SUT's program calls itself (its version, its kind of machine), and with the
/// numbers that it reports to ten decimals: std::hypot and its like differ between machines in the
/// last bit. Line by line, because all that the host measured and the SUT commanded must be the
/// same to the last bit.
std::string comparable(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    line = std::regex_replace(line, std::regex("tether-sut [^\"]*"), "tether-sut");
    if (line.starts_with("annotation"))
      line = std::regex_replace(line, std::regex("(\\.[0-9]{10})[0-9]+"), "$1");
    result += line + '\n';
  }
  return result;
}

class Arm64 : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kSources / "build/arm64/bin/tether-sut"))
      GTEST_SKIP() << "the programs for ARM are not built: run scripts/build-arm64";
  }
  /// One run whose SUT is started so, with a scripted clock.
  void fly(const std::string& out, const std::vector<std::string>& sut) const {
    ExternalRun run(scenario_, folder_ / out);
    const Output flown = run.start_sut(sut)->wait(90s);
    ASSERT_EQ(flown.code, 0) << flown.err;
    const Output output = run.wait(20s);
    ASSERT_EQ(output.code, 0) << output.err;
  }

  TempFolder folder_;
  std::filesystem::path scenario_ = write_face_scenario(folder_.path(), {kScripted});
};

TEST_F(Arm64, FliesAsTheTargetOfASynchronisedRun) {
  const auto target = kSources / "data/profiles/targets/qemu_aarch64.toml";
  const Output output = run(tether({"run", scenario_, "--force", "--target", target, "--out",
                                    folder_ / "out", "--quiet"}),
                            100s);
  const auto result = read_result(folder_ / "out");
  EXPECT_EQ(result["outcome"], "goal_reached") << output.err;
  EXPECT_EQ(result["condition"], "qemu_aarch64");
  EXPECT_TRUE(result["audit"]["passed"]);
  EXPECT_EQ(result["sync"]["causality_violations"], 0);
  EXPECT_THAT(result["suts"][0]["sut"].get<std::string>(), HasSubstr("(aarch64)"));
  EXPECT_THAT(read_record(folder_ / "out").header.suts.at(0).sut, HasSubstr("(aarch64)"));
}

TEST_F(Arm64, IsTheSameToTheByteUnderTheCountedClock) {
  const auto target = folder_ / "counted_arm64.toml";
  const auto quoted = [](const char* path) { return '"' + (kSources / path).string() + '"'; };
  write_text(
      target,
      substituted(read_text(kSources / "data/profiles/targets/counted_host.toml"),
                  {{"qemu-x86_64\"\n", "qemu-aarch64\"\n"},
                   {"\"Nehalem\"", "\"cortex-a72\"\nprogram_folder = " + quoted("build/arm64/bin") +
                                       "\nsysroot = " + quoted("build/sysroot-arm64")}}));
  const auto scenario = write_shipped_scenario(folder_.path(), "face_anchor",
                                               {{"\ntime_limit_s = 60", "\ntime_limit_s = 0.25"}});
  for (const std::string out : {"first", "second"}) {
    const Output output = run(tether({"run", scenario, "--condition", "host", "--target", target,
                                      "--out", folder_ / out, "--quiet"}),
                              100s);
    ASSERT_EQ(output.code, 1) << output.err;
  }
  EXPECT_THAT(read_record(folder_ / "first").header.suts.at(0).sut, HasSubstr("(aarch64)"));
  EXPECT_GT(read_result(folder_ / "first")["sync"]["interactions"], 5);
  EXPECT_TRUE(read_text(folder_ / "first/record.mcap") ==
              read_text(folder_ / "second/record.mcap"));
}

// Every image is tracked, and every command given, as on this machine.
TEST_F(Arm64, ComputesWhatThisMachineComputes) {
  fly("here", face_sut());
  fly("there", emulated(face_sut()));
  const std::string record = comparable(timeless_record(folder_ / "here"));
  EXPECT_GT(record.size(), 10'000u);
  EXPECT_THAT(record, HasSubstr("\"distance_m\""));
  EXPECT_TRUE(record == comparable(timeless_record(folder_ / "there"))) << "the records differ";
}

TEST_F(Arm64, DrawsThePicturesThatThisMachineDraws) {
  std::vector<std::string> drawing{"raster_elsewhere", "--gtest_filter=Renderer.Gives*Bytes*"};
  const Output output = run({emulated(drawing)}, 300s);
  EXPECT_EQ(output.code, 0) << output.out << output.err;
  EXPECT_THAT(output.out, HasSubstr("[  PASSED  ] 1 test"));
}

/// The names in a package's Depends; each has to come with a least version.
std::vector<std::string> needs_of(const std::string& package) {
  const auto file =
      kSources / "build/arm64/packages" / (package + "_" TETHER_VERSION_NUMBER "_arm64.deb");
  const Output depends = run({{"dpkg-deb", "-f", file, "Depends"}});
  EXPECT_EQ(depends.code, 0) << depends.err << "scripts/build-arm64 makes it";
  std::vector<std::string> names;
  const std::regex need("([a-z0-9.+-]+) \\(>= [^)]+\\)");
  for (std::sregex_iterator it(depends.out.begin(), depends.out.end(), need), end; it != end; ++it)
    names.push_back((*it)[1]);
  return names;
}

TEST_F(Arm64, PackagesNeedWhatDebianHas) {
  const auto of_sut = needs_of("tether-sut");
  EXPECT_THAT(of_sut, testing::IsSupersetOf({"libc6", "libstdc++6", "libopencv-core406"}));
  EXPECT_THAT(needs_of("libtether-client1"),
              testing::UnorderedElementsAre("libc6", "libgcc-s1", "libstdc++6"));
  const std::string installed = read_text(kSources / "build/sysroot-arm64/var/lib/dpkg/status");
  for (const std::string& name : of_sut)
    EXPECT_THAT(installed, HasSubstr("Package: " + name + "\n"));
}

}  // namespace
}  // namespace tether::system_test
