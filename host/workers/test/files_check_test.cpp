#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/workers/files_check.h>

namespace tether::workers {
namespace {

TEST(FilesCheck, AcceptsTheSameContentOnly) {
  const ScratchFolder scratch;
  const auto a = scratch.write("a", "1"), b = scratch.write("b", "2");
  const auto digests = digests_of({a, b, a});
  require_same_files(digests);
  scratch.write("b", "2");  // written again
  require_same_files(digests);
  scratch.write("b", "3");
  EXPECT_EQ(bad_file_error([&] { require_same_files(digests); }).where().file, b.string());
  EXPECT_EQ(bad_file_error([&] { require_same_files(digests); }).where().file, b.string());
  std::filesystem::remove(a);
  EXPECT_EQ(bad_file_error([&] { require_same_files(digests); }).where().file, a.string());
}

}  // namespace
}  // namespace tether::workers
