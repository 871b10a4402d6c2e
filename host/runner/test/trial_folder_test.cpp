#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/runner/trial_folder.h>

namespace tether::runner {
namespace {

TEST(TrialFolder, IsCreatedForOneRunAtATime) {
  const ScratchFolder scratch;
  const std::filesystem::path path = scratch.path("a/b");
  {
    const TrialFolder first(path);
    EXPECT_TRUE(std::filesystem::is_directory(path));
    const Error error = thrown_error(ErrorCode::kUsage, [&] { const TrialFolder second(path); });
    EXPECT_EQ(error.subject(), path);
  }
  EXPECT_NO_THROW(TrialFolder{path});
}

TEST(TrialFolder, RemovesOnlyTheFilesOfAnEarlierTrial) {
  const ScratchFolder scratch;
  for (const char* file : {"result.json", kRecordFile, kSimulatorLog, kWarningsFile, "notes.txt"})
    scratch.write(file, "text");
  const TrialFolder folder(scratch.path());
  for (const char* file : {"result.json", kRecordFile, kSimulatorLog, kWarningsFile})
    EXPECT_FALSE(std::filesystem::exists(scratch.path(file))) << file;
  EXPECT_TRUE(std::filesystem::exists(scratch.path("notes.txt")));
}

TEST(TrialFolder, ReportsAFolderThatCannotBeCreated) {
  const ScratchFolder scratch;
  const std::filesystem::path path = scratch.write("file", "text") / "out";
  EXPECT_NE(thrown_error(ErrorCode::kSetup, [&] { TrialFolder{path}; }).subject(), "");
}

}  // namespace
}  // namespace tether::runner
