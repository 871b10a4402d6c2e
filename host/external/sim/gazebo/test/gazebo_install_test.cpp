#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/sim_gazebo/gazebo_simulator.h>

namespace tether::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Puts environment variables back as they were.
class KeptVariables {
 public:
  KeptVariables() {
    for (const char* name :
         {"TETHER_GAZEBO_ROOT", "TETHER_GAZEBO_PLUGIN", "PATH", "GAZEBO_RESOURCE_PATH"}) {
      const char* value = std::getenv(name);
      before_.emplace_back(name, value ? std::optional<std::string>(value) : std::nullopt);
    }
  }
  ~KeptVariables() {
    for (const auto& [name, value] : before_)
      value ? setenv(name, value->c_str(), 1) : unsetenv(name);
  }
  KeptVariables(const KeptVariables&) = delete;
  KeptVariables& operator=(const KeptVariables&) = delete;

 private:
  std::vector<std::pair<const char*, std::optional<std::string>>> before_;
};

/// A root with the files of Gazebo that are checked before it is started.
class GazeboInstallTest : public testing::Test {
 protected:
  void SetUp() override {
    write_program("root/lib/x86_64-linux-gnu/ld-linux-x86-64.so.2");
    write_program("root/usr/bin/gzserver");
    scratch_.write("libtether_gazebo.so", "");
    setenv("TETHER_GAZEBO_ROOT", scratch_.path("root").c_str(), 1);
    setenv("TETHER_GAZEBO_PLUGIN", scratch_.path("libtether_gazebo.so").c_str(), 1);
    setenv("PATH", scratch_.path("bin").c_str(), 1);
  }
  std::filesystem::path write_program(const std::string& name) {
    const auto file = scratch_.write(name, "#!/bin/sh\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
  }
  static Error error() {
    return thrown_error(ErrorCode::kSetup, [] { find_gazebo(); });
  }
  static bool has_root_of_builds() {
    try {
      return find_gazebo().command.size() > 1;
    } catch (const Error&) {
      return false;
    }
  }
  const KeptVariables kept_;
  ScratchFolder scratch_;
};

TEST_F(GazeboInstallTest, RunsARootsProgramWithItsLoaderAndLibraries) {
  setenv("GAZEBO_RESOURCE_PATH", "/home/me/media", 1);
  const GazeboInstall install = find_gazebo();
  const auto root = scratch_.path("root");
  EXPECT_THAT(install.command,
              ElementsAre(root / "lib/x86_64-linux-gnu/ld-linux-x86-64.so.2", "--library-path",
                          HasSubstr((root / "usr/lib/x86_64-linux-gnu").string() + ":"),
                          root / "usr/bin/gzserver"));
  EXPECT_EQ(install.plugin, scratch_.path("libtether_gazebo.so"));
  EXPECT_THAT(install.files(), ElementsAre(root / "usr/bin/gzserver", install.plugin));
  const std::map<std::string, std::string> variables(install.environment.begin(),
                                                     install.environment.end());
  EXPECT_EQ(variables.at("LIBGL_DRIVERS_PATH"), root / "usr/lib/x86_64-linux-gnu/dri");
  EXPECT_EQ(variables.at("LD_PRELOAD"), "");
  EXPECT_EQ(variables.at("LD_LIBRARY_PATH"), "");
  EXPECT_EQ(variables.at("GAZEBO_RESOURCE_PATH"),
            (root / "usr/share/gazebo-11").string() + ":/home/me/media");
}

TEST_F(GazeboInstallTest, AcceptsRelativePaths) {
  std::filesystem::current_path(scratch_.path("."));
  setenv("TETHER_GAZEBO_ROOT", "root", 1);
  setenv("TETHER_GAZEBO_PLUGIN", "libtether_gazebo.so", 1);
  EXPECT_EQ(find_gazebo().gzserver, scratch_.path("root/usr/bin/gzserver"));
  EXPECT_TRUE(find_gazebo().plugin.is_absolute());
}

TEST_F(GazeboInstallTest, RefusesARootWithoutGazeboAndAMissingPlugin) {
  setenv("TETHER_GAZEBO_PLUGIN", "/nowhere/plugin.so", 1);
  EXPECT_EQ(error().subject(), "TETHER_GAZEBO_PLUGIN");
  EXPECT_THAT(error().what(), HasSubstr("/nowhere/plugin.so"));
  std::filesystem::remove(scratch_.path("root/usr/bin/gzserver"));
  EXPECT_EQ(error().subject(), "TETHER_GAZEBO_ROOT");
  EXPECT_THAT(error().what(), HasSubstr(scratch_.path("root").string()));
}

TEST_F(GazeboInstallTest, UsesTheSystemsGazeboWithoutARoot) {
  unsetenv("TETHER_GAZEBO_ROOT");
  if (has_root_of_builds()) GTEST_SKIP() << "there is a root in the folder of this build";
  EXPECT_EQ(error().subject(), "gzserver");
  const auto program = write_program("bin/gzserver");
  EXPECT_THAT(find_gazebo().command, ElementsAre(program));
}

}  // namespace
}  // namespace tether::sim
