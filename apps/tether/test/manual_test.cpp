#include "shared/manual.h"

#include "shared/command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>

namespace tether::app {
namespace {

using testing::HasSubstr;

class Manual : public testing::Test {
 protected:
  Manual() {
    const Option shared{"--seed", "Seed of noise", &seed_, range(0, 9)};
    add_command(program_, "run", "Run one trial",
                {{"scenario", "Name", &text_, required()},
                 {"--out FOLDER", "It's a folder. With files [out/one]", &text_},
                 {"--format", "Form", &format_, one_of({"text", "html"})},
                 shared},
                "Exit codes: 0 reached, 1 missed, or late,\n2 wrong use.\n\n"
                "Examples:\n  demo run a --seed 1");
    add_command(program_, "world", "Check worlds", {}, "");
    add_command(program_, "world check", "Check a world", {shared}, "");
    program_.footer("Environment (of all):\n  DEMO_UAV  the UAV\n\nExamples:\n  demo run a");
  }
  std::string page(const std::string& text) { return manual_page(program_, text); }

  std::string text_, format_ = "text";
  std::uint64_t seed_ = 7;
  CLI::App program_{"Does something.", "demo"};
};

TEST_F(Manual, ListsCommandsWithWhatTheyNeed) {
  EXPECT_EQ(page("@synopsis@\n"),
            ".Sh SYNOPSIS\n.Nm\n.Cm run\n.Op Ar options\n.Ar scenario\n"
            ".Nm\n.Cm world check\n.Op Fl -seed Ar NUMBER\n"
            ".Nm\n.Op Ar command\n.Fl -help\n.Nm\n.Fl -version\n");
}

TEST_F(Manual, DescribesAnOptionWithItsValuesAndItsDefault) {
  const std::string options = page("@options@\n");
  for (const char* row : {".It Ar scenario\nName.\n",
                          ".It Fl -out Ar FOLDER\nIt\\(aqs a folder.\nWith files.\nThe default is "
                          "out/one.\n",
                          ".It Fl -format Cm text|html\nForm.\nThe default is text.\n",
                          ".It Fl -seed Ar NUMBER\nSeed of noise.\nA whole number from 0 to 9.\n"
                          "The default is 7.\n"})
    EXPECT_THAT(options, HasSubstr(row));
}

TEST_F(Manual, DescribesAnOptionOfSeveralCommandsOnce) {
  EXPECT_THAT(page("@options@\n"), HasSubstr(".Ss world check\nCheck a world.\n.Pp\nAs for\n"
                                             ".Cm run :\n.Fl -seed .\n"));
}

TEST_F(Manual, HasTheEndOfTheHelp) {
  EXPECT_THAT(page("@options@\n"),
              HasSubstr(".Pp\nExit codes:\n.Bl -tag -width Ds\n.It 0\nReached.\n.It 1\nMissed, or "
                        "late.\n.It 2\nWrong use.\n.El\n"
                        ".Pp\nExamples:\n.Dl demo run a \\-\\-seed 1\n"));
  EXPECT_EQ(page("a\n@Environment@\n@Examples@\nb\n"),
            "a\n.Bl -tag -width Ds\n.It Ev DEMO_UAV\nthe UAV.\n.El\n.Dl demo run a\nb\n");
}

TEST_F(Manual, RefusesAPartThatTheHelpLacks) {
  EXPECT_THROW(page("@Files@\n"), Error);
}

TEST_F(Manual, IsPrintedForTheBuild) {
  ScratchFolder folder;
  const std::string file = folder.write("page", "@Examples@\n");
  EXPECT_EQ(asked_manual_page(program_, {"--manual-page", file}), ".Dl demo run a\n");
  EXPECT_EQ(asked_manual_page(program_, {"run", file}), std::nullopt);
}

}  // namespace
}  // namespace tether::app
