#include "options/junit_option.h"

#include <gmock/gmock.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/text_file.h>

namespace tether::app {
namespace {

using ::testing::HasSubstr;

TEST(JunitOption, TheFileIsThereFromTheStart) {
  const ScratchFolder scratch;
  const auto file = scratch.path("new/junit.xml");
  EXPECT_EQ(with_junit(file, "s",
                       [&] {
                         EXPECT_THAT(os::read_file(file), HasSubstr("did not run to its end"));
                         return 3;
                       }),
            3);
}

TEST(JunitOption, TheFileHasTheReasonOfAnError) {
  const ScratchFolder scratch;
  const auto file = scratch.path("junit.xml");
  bad_file_error([&] {
    with_junit(file, "s", []() -> int { throw Error(ErrorCode::kBadFile, "a bad key"); });
  });
  EXPECT_THAT(os::read_file(file), HasSubstr("a bad key"));
}

TEST(JunitOption, AFileThatIsNoJunitFileIsRefusedAndKept) {
  const ScratchFolder scratch;
  const auto file = scratch.write("q.toml", "world = \"room\"\n");
  const Error error =
      thrown_error(ErrorCode::kUsage, [&] { with_junit(file, "s", [] { return 0; }); });
  EXPECT_EQ(error.subject(), "--junit");
  EXPECT_EQ(os::read_file(file), "world = \"room\"\n");
}

TEST(JunitOption, NoFileIsNeeded) {
  EXPECT_EQ(with_junit("", "s", [] { return 7; }), 7);
}

TEST(JunitOption, AFileThatCannotBeWrittenIsRefusedBeforeTheCommand) {
  thrown_error(ErrorCode::kSetup, [] {
    with_junit("/proc/none/junit.xml", "s", []() -> int {
      ADD_FAILURE();
      return 0;
    });
  });
}

}  // namespace
}  // namespace tether::app
