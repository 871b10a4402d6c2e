#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/campaign/result.h>
#include <tether/runner/trial_folder.h>

namespace tether::runner {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

class TrialFolderTest : public testing::Test {
 protected:
  /// The names in the folder, of a file in a subfolder the path.
  std::vector<std::string> content() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(scratch_.path()))
      names.push_back(entry.path().lexically_relative(scratch_.path()).string());
    std::ranges::sort(names);
    return names;
  }
  void write(std::initializer_list<const char*> files) const {
    for (const char* file : files) scratch_.write(file, "text");
  }
  /// Leaves a finished run, its SUT's files, and what is made of its record later.
  void fly() const {
    campaign::TrialResult result;
    {
      const TrialFolder folder(scratch_.path(), EarlierRun::kReplace);
      write({kRecordFile, "sut-uav1.log", "flight.csv", "uav1/pictures/1.png"});
      result.this_run.sut_files = folder.files_of_suts();
    }
    EXPECT_THAT(result.this_run.sut_files, ElementsAre("flight.csv", "uav1/pictures/1.png"));
    campaign::write_result(scratch_.path(), result);
    write({"report.html", "plots/lag.svg", "frames/a-b-000001.svg"});
  }
  void expect_refused(EarlierRun earlier, const std::string& name = "") const {
    const std::vector<std::string> before = content();
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { TrialFolder(scratch_.path(), earlier); });
    EXPECT_EQ(error.subject(), scratch_.path());
    EXPECT_THAT(error.what(), testing::HasSubstr(name));
    EXPECT_EQ(content(), before);
  }

  ScratchFolder scratch_;
};

TEST_F(TrialFolderTest, IsCreatedForOneRunAtATime) {
  const fs::path path = scratch_.path("a/b");
  {
    const TrialFolder first(path, EarlierRun::kRefuse);
    EXPECT_TRUE(fs::is_directory(path));
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { TrialFolder(path, EarlierRun::kReplace); });
    EXPECT_EQ(error.subject(), path);
  }
  EXPECT_NO_THROW(TrialFolder(path, EarlierRun::kRefuse));
}

TEST_F(TrialFolderTest, ReplacesAnEarlierRunAsAWholeOrRefusesIt) {
  write({"README"});
  fly();
  expect_refused(EarlierRun::kRefuse);
  expect_refused(EarlierRun::kReplace, "'README'");
  fs::remove(scratch_.path("README"));
  for (const char* stranger : {"notes.txt", "plots/mine.png", "uav1/pictures/2.png"}) {
    write({stranger});
    expect_refused(EarlierRun::kReplace, stranger);
    fs::remove(scratch_.path(stranger));
  }
  { const TrialFolder folder(scratch_.path(), EarlierRun::kReplace); }
  EXPECT_THAT(content(), ElementsAre());
}

TEST_F(TrialFolderTest, KeepsTheScenarioOfTheRunAndReplacesOneThatWasMadeForAnother) {
  const std::string made = scratch_.write(kMadeScenarioFile, std::string(kMadeScenario) + "\n");
  fly();
  { const TrialFolder folder(scratch_.path(), EarlierRun::kReplace, made); }
  EXPECT_THAT(content(), ElementsAre(kMadeScenarioFile));
  fly();
  { const TrialFolder folder(scratch_.path(), EarlierRun::kReplace); }
  EXPECT_THAT(content(), ElementsAre());
  scratch_.write(kMadeScenarioFile, "name = \"of_the_user\"\n");
  fly();
  expect_refused(EarlierRun::kReplace, kMadeScenarioFile);
}

TEST_F(TrialFolderTest, ReplacesJunitFilesOfAnyNameButNoOtherXml) {
  fly();
  scratch_.write("ci/j.xml", std::string(campaign::kJunitBegin) + "</testsuites>\n");
  scratch_.write("junit.xml", "<notes/>");
  expect_refused(EarlierRun::kReplace, "has 'junit.xml', which");
  fs::remove(scratch_.path("junit.xml"));
  { const TrialFolder folder(scratch_.path(), EarlierRun::kReplace); }
  EXPECT_THAT(content(), ElementsAre());
}

// Killed before it had a result, or damaged.
TEST_F(TrialFolderTest, RecognizesARunByAnyOfItsFiles) {
  for (const char* file :
       {"result.json", kRecordFile, kSimulatorLog, kWarningsFile, "sut-uav1.log"}) {
    write({file, "run.log", "result.json.part"});
    expect_refused(EarlierRun::kRefuse);
    { const TrialFolder folder(scratch_.path(), EarlierRun::kReplace); }
    EXPECT_THAT(content(), ElementsAre()) << file;
  }
}

TEST_F(TrialFolderTest, KeepsFilesOfOthersUnlessTheySeemToBeOfARun) {
  write({"notes.txt", "run.log"});
  { const TrialFolder folder(scratch_.path(), EarlierRun::kReplace); }
  EXPECT_THAT(content(), ElementsAre("notes.txt", "run.log"));
  for (const char* file : {"campaign.json", "report.html", "plots/lag.svg", "frames/1.svg"}) {
    write({file});
    expect_refused(EarlierRun::kReplace);
    fs::remove_all(scratch_.path() / *fs::path(file).begin());
  }
}

TEST_F(TrialFolderTest, ReportsAFolderThatCannotBeCreated) {
  const fs::path path = scratch_.write("file", "text") / "out";
  const auto create = [&] { TrialFolder(path, EarlierRun::kReplace); };
  EXPECT_NE(thrown_error(ErrorCode::kUsage, create).subject(), "");
}

}  // namespace
}  // namespace tether::runner
