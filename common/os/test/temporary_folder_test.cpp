#include <fstream>
#include <optional>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/temporary_folder.h>

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

}  // namespace
}  // namespace tether::os
