#include <gtest/gtest.h>

#include <tether/os/child_process.h>

namespace tether::os {
namespace {

TEST(ShellWord, LeavesPlainWordsAsTheyAre) {
  EXPECT_EQ(shell_word("/usr/bin/fly-1_a.b:c"), "/usr/bin/fly-1_a.b:c");
}

TEST(ShellWord, IsOneWordWithTheSameTextToAShell) {
  for (const std::string text :
       {"", "two words", "it's", "$HOME `id` \"x\"", "a\nb", "*", "\\", "-n; exit 1"}) {
    const Captured said = run_captured(
        {"sh", "-c", "count() { printf '%s|%s' $# \"$1\"; }; count " + shell_word(text)}, "",
        std::chrono::seconds(60));
    EXPECT_EQ(said.out, "1|" + text);
  }
}

}  // namespace
}  // namespace tether::os
