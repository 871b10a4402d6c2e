#include <atomic>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

TEST(TemporaryFolder, IsThisUsersAloneAndGoesWithItsContent) {
  const ScratchFolder parent;
  std::optional<TemporaryFolder> folder(std::in_place, "some-", parent.path());
  EXPECT_TRUE(folder->path().filename().string().starts_with("some-"));
  EXPECT_EQ(std::filesystem::status(folder->path()).permissions(),
            std::filesystem::perms::owner_all);
  std::ofstream(*folder / "file") << "text";
  folder.reset();
  EXPECT_TRUE(std::filesystem::is_empty(parent.path()));
}

TEST(TemporaryFolder, SaysWhichFolderCannotBeMade) {
  const Error error = thrown_error(ErrorCode::kSetup, [] { TemporaryFolder("some-", "/nowhere"); });
  EXPECT_TRUE(error.where().file.starts_with("/nowhere/some-")) << error.what();
}

// A thread makes folders and files until the process ends.
TEST(TemporaryFolder, IsGoneWithAProcessThatEndsAtOnce) {
  const ScratchFolder parent;
  setenv("TMPDIR", parent.path().c_str(), 1);
  EXPECT_EXIT(
      {
        std::atomic<int> made{0};
        const std::thread maker([&made] {
          for (std::vector<std::unique_ptr<TemporaryFolder>> folders;; ++made) {
            folders.push_back(std::make_unique<TemporaryFolder>("some-"));
            std::ofstream(*folders.back() / "file") << "text";
          }
        });
        while (made < 20) std::this_thread::yield();
        end_without_temporary_folders(7);
      },
      ::testing::ExitedWithCode(7), "");
  unsetenv("TMPDIR");
  EXPECT_TRUE(std::filesystem::is_empty(parent.path()));
}

}  // namespace
}  // namespace tether::os
