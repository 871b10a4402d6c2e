
#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/sim_gazebo/gazebo_install.h>

namespace tether::sim {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Puts environment variables back as they were.
class KeptVariables {
 public:
  KeptVariables() {
    for (const char* name :
         {"TETHER_GAZEBO_ROOT", "TETHER_GAZEBO_PLUGIN", "PATH", "GAZEBO_RESOURCE_PATH"})
      if (const char* value = std::getenv(name))
        before_.emplace_back(name, value);
      else
        before_.emplace_back(name, std::nullopt);
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

/// A root with Gazebo in it, as far as anybody looks before starting it.
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
  std::string error() {
    return error_message(ErrorCode::kSetup, [] { find_gazebo(); });
  }
  const KeptVariables kept_;
  ScratchFolder scratch_;
};

std::string value_of(const os::Environment& environment, const std::string& name) {
  const auto found = std::ranges::find(environment, name, [](const auto& v) { return v.first; });
  return found == environment.end() ? "not there" : found->second;
}

TEST_F(GazeboInstallTest, ARootsProgramIsRunByTheRootsLoader) {
  const GazeboInstall install = find_gazebo();
  const auto root = scratch_.path("root");
  EXPECT_THAT(install.command,
              ElementsAre(root / "lib/x86_64-linux-gnu/ld-linux-x86-64.so.2", "--library-path",
                          HasSubstr((root / "usr/lib/x86_64-linux-gnu").string() + ":"),
                          root / "usr/bin/gzserver"));
  EXPECT_EQ(install.plugin, scratch_.path("libtether_gazebo.so"));
  EXPECT_THAT(install.files(), ElementsAre(root / "usr/bin/gzserver", install.plugin));
  EXPECT_EQ(value_of(install.environment, "LIBGL_DRIVERS_PATH"),
            root / "usr/lib/x86_64-linux-gnu/dri");
}

TEST_F(GazeboInstallTest, NothingOfThisSystemsLibrariesIsMixedIn) {
  const GazeboInstall install = find_gazebo();
  EXPECT_EQ(value_of(install.environment, "LD_PRELOAD"), "");
  EXPECT_EQ(value_of(install.environment, "LD_LIBRARY_PATH"), "");
}

TEST_F(GazeboInstallTest, WhatTheUserAddsComesAfterTheRootsOwn) {
  setenv("GAZEBO_RESOURCE_PATH", "/home/me/media", 1);
  EXPECT_EQ(value_of(find_gazebo().environment, "GAZEBO_RESOURCE_PATH"),
            scratch_.path("root/usr/share/gazebo-11").string() + ":/home/me/media");
}

TEST_F(GazeboInstallTest, ARelativeRootIsTakenFromHere) {
  std::filesystem::current_path(scratch_.path("."));
  setenv("TETHER_GAZEBO_ROOT", "root", 1);
  setenv("TETHER_GAZEBO_PLUGIN", "libtether_gazebo.so", 1);
  EXPECT_EQ(find_gazebo().gzserver, scratch_.path("root/usr/bin/gzserver"));
  EXPECT_TRUE(find_gazebo().plugin.is_absolute());
}

TEST_F(GazeboInstallTest, ARootThatHasNoGazeboIsNamed) {
  std::filesystem::remove(scratch_.path("root/usr/bin/gzserver"));
  EXPECT_THAT(error(), HasSubstr("TETHER_GAZEBO_ROOT names " + scratch_.path("root").string()));
  EXPECT_THAT(error(), HasSubstr("scripts/gazebo-root"));
}

TEST_F(GazeboInstallTest, ThePluginThatIsNotThereIsNamed) {
  setenv("TETHER_GAZEBO_PLUGIN", "/nowhere/plugin.so", 1);
  EXPECT_THAT(error(), HasSubstr("TETHER_GAZEBO_PLUGIN names /nowhere/plugin.so"));
}

/// Without a root that is named, one may be in the folder of this build.
bool has_root_of_builds() {
  unsetenv("TETHER_GAZEBO_ROOT");
  try {
    return find_gazebo().command.size() > 1;
  } catch (const Error&) {
    return false;
  }
}

TEST_F(GazeboInstallTest, WithoutARootTheSystemsGazeboIsTaken) {
  if (has_root_of_builds()) GTEST_SKIP() << "there is a root";
  EXPECT_THAT(error(), HasSubstr("gzserver is not in PATH"));
  EXPECT_THAT(error(), HasSubstr("scripts/gazebo-root"));
  const auto program = write_program("bin/gzserver");
  EXPECT_THAT(find_gazebo().command, ElementsAre(program));
}

}  // namespace
}  // namespace tether::sim
