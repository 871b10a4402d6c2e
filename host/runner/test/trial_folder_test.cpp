#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/runner/trial_folder.h>

namespace tether::runner {
namespace {

using testing::HasSubstr;

TEST(TrialFolder, IsMade) {
  const ScratchFolder scratch;
  const TrialFolder folder(scratch.path("a/b"));
  EXPECT_TRUE(std::filesystem::is_directory(scratch.path("a/b")));
}

TEST(TrialFolder, DropsWhatAnEarlierTrialLeftAndNothingElse) {
  const ScratchFolder scratch;
  for (const char* file : {"result.json", kRecordFile, kSimulatorLog, "notes.txt"})
    scratch.write(file, "text");
  const TrialFolder folder(scratch.path());
  for (const char* file : {"result.json", kRecordFile, kSimulatorLog})
    EXPECT_FALSE(std::filesystem::exists(scratch.path(file))) << file;
  EXPECT_TRUE(std::filesystem::exists(scratch.path("notes.txt")));
}

TEST(TrialFolder, IsOfOneRunAtATime) {
  const ScratchFolder scratch;
  const std::filesystem::path path = scratch.path("out");
  {
    const TrialFolder first(path);
    EXPECT_THAT(error_message(ErrorCode::kUsage, [&] { const TrialFolder second(path); }),
                HasSubstr("another run writes there"));
  }
  EXPECT_NO_THROW(TrialFolder{path});
}

TEST(TrialFolder, IsRefusedWhereItCannotBeMade) {
  const ScratchFolder scratch;
  EXPECT_THAT(
      error_message(ErrorCode::kSetup, [&] { TrialFolder(scratch.write("file", "text") / "out"); }),
      HasSubstr("choose another folder with --out"));
}

}  // namespace
}  // namespace tether::runner
