#include "target_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

using std::filesystem::path;

TEST(TargetOption, TellsFilesAddressesAndWaitingApart) {
  EXPECT_TRUE(std::holds_alternative<std::monostate>(parse_target_option("")));
  EXPECT_TRUE(std::holds_alternative<WaitForSut>(parse_target_option("wait")));
  const TargetOption board = parse_target_option("ssh://pi@board:2222");
  ASSERT_TRUE(std::holds_alternative<scenario::SshAddress>(board));
  EXPECT_EQ(std::get<scenario::SshAddress>(board).destination, "pi@board");
  for (const std::string file : {"slow.toml", "./wait", "targets/wait", "Wait", "ssh:board"}) {
    const TargetOption option = parse_target_option(file);
    ASSERT_TRUE(std::holds_alternative<path>(option)) << file;
    EXPECT_EQ(std::get<path>(option), path(file));
  }
}

TEST(TargetOption, AnAddressThatIsNoneIsWrongUse) {
  for (const std::string text : {"ssh://", "http://board", "://"})
    EXPECT_NE(error_message(ErrorCode::kUsage, [&] { parse_target_option(text); }), "");
}

}  // namespace
}  // namespace tether::app
