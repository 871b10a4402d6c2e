#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/runner/trial_request.h>

namespace tether::runner {
namespace {

TEST(TargetChoice, IsAFileAnAddressOrWait) {
  EXPECT_TRUE(std::holds_alternative<std::monostate>(parse_target_choice("")));
  EXPECT_TRUE(std::holds_alternative<WaitForSut>(parse_target_choice("wait")));
  EXPECT_EQ(std::get<scenario::SshAddress>(parse_target_choice("ssh://pi@board:2222")).destination,
            "pi@board");
  for (const std::string file : {"slow.toml", "./wait", "targets/wait", "Wait", "a@b/slow.toml"})
    EXPECT_EQ(std::get<std::filesystem::path>(parse_target_choice(file)), file);
  for (const std::string text :
       {"ssh://", "http://board", "://", "ssh:board", "ssh:/board", "pi@board"})
    thrown_error(ErrorCode::kUsage, [&] { parse_target_choice(text); });
}

}  // namespace
}  // namespace tether::runner
