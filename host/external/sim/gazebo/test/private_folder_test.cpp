#include "private_folder.h"

#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tether::sim {
namespace {

namespace fs = std::filesystem;

std::string prefix_of_test() {
  return "tether-private-test-" + std::to_string(getpid()) + "-";
}

TEST(PrivateFolder, IsForThisUserOnlyAndIsRemovedWithItsFiles) {
  fs::path path;
  {
    const PrivateFolder folder(prefix_of_test());
    path = folder.path();
    EXPECT_EQ(path.parent_path(), "/tmp");
    EXPECT_TRUE(path.filename().string().starts_with(prefix_of_test()));
    struct stat found {};
    ASSERT_EQ(lstat(path.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 07777, 0700u);
    fs::create_directory(path / "inner");
    std::ofstream(path / "inner/file") << "text";
  }
  EXPECT_FALSE(fs::exists(path));
}

/// Makes a folder in a process that is killed; returns it.
fs::path left_by_a_killed_process(const std::string& prefix) {
  int name[2];
  EXPECT_EQ(pipe(name), 0);
  const pid_t child = fork();
  if (child == 0) {
    const PrivateFolder folder(prefix);
    const std::string path = folder.path();
    if (write(name[1], path.data(), path.size()) > 0) raise(SIGKILL);
    _exit(1);
  }
  waitpid(child, nullptr, 0);
  char buffer[200];
  const auto size = read(name[0], buffer, sizeof buffer);
  close(name[0]);
  close(name[1]);
  return std::string(buffer, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
}

TEST(PrivateFolder, OfAKilledProcessIsRemovedByTheNextProcess) {
  const fs::path left = left_by_a_killed_process(prefix_of_test());
  ASSERT_TRUE(fs::is_directory(left));
  const PrivateFolder other("tether-private-other-");
  EXPECT_TRUE(fs::exists(left));
  const PrivateFolder first(prefix_of_test()), second(prefix_of_test());
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(first.path())) << "in use";
  EXPECT_NE(first.path(), second.path());
}

// A link of that name is not a folder of Tether.
TEST(PrivateFolder, FollowsNoLinkWhenItCleansUp) {
  const fs::path file = "/tmp/" + prefix_of_test() + "target",
                 link = "/tmp/" + prefix_of_test() + "x";
  fs::create_directory(file);
  fs::create_directory_symlink(file, link);
  std::ofstream(file / "kept") << "text";
  { const PrivateFolder other("tether-private-other-"); }
  { const PrivateFolder folder(prefix_of_test() + "x"); }
  EXPECT_TRUE(fs::exists(file / "kept"));
  fs::remove(link);
  fs::remove_all(file);
}

}  // namespace
}  // namespace tether::sim
