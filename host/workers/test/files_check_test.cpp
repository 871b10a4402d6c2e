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
  FilesCheck check(digests);
  check.require_unchanged();
  scratch.write("b", "2");  // written again
  check.require_unchanged();
  scratch.write("b", "3");
  EXPECT_EQ(bad_file_error([&] { check.require_unchanged(); }).where().file, b.string());
  EXPECT_EQ(bad_file_error([&] { FilesCheck{digests}; }).where().file, b.string());
  std::filesystem::remove(a);
  EXPECT_EQ(bad_file_error([&] { check.require_unchanged(); }).where().file, a.string());
}

}  // namespace
}  // namespace tether::workers
