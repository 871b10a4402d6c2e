#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>

namespace tether {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ScratchFolder, IsNewEmptyAndRemovedWithItsObject) {
  const ScratchFolder other;
  auto folder = std::make_unique<ScratchFolder>();
  const fs::path path = folder->path();
  EXPECT_NE(path, other.path());
  EXPECT_TRUE(fs::is_empty(path));
  folder->write("a/b", "text");
  folder.reset();
  EXPECT_FALSE(fs::exists(path));
}

TEST(ScratchFolder, WritesWholeFilesAndTheirFolders) {
  const ScratchFolder folder;
  const fs::path file = folder.write("a/b/c", "longer\n");
  EXPECT_EQ(file, folder.path() / "a/b/c");
  EXPECT_EQ(file, folder.path("a/b/c"));
  EXPECT_EQ(text_of(file), "longer\n");
  folder.write("a/b/c", "new");
  EXPECT_EQ(text_of(file), "new");
  EXPECT_THROW(folder.write("a", "is a folder"), std::runtime_error);
}

// In a child process, because this test must not fail.
TEST(ScratchFolder, IsKeptWhenTheTestHasFailed) {
  auto folder = std::make_unique<ScratchFolder>();
  const fs::path file = folder->write("a/b", "text");
  const auto fail_and_end = [&] {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    ADD_FAILURE();
    folder.reset();
    std::_Exit(fs::exists(file) ? 0 : 1);
  };
  EXPECT_EXIT(fail_and_end(), testing::ExitedWithCode(0), "kept: \"" + folder->path().string());
}

}  // namespace
}  // namespace tether
