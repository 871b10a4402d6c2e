#include <gtest/gtest.h>

#include <tether/report/verdict.h>

namespace tether::report {
namespace {

TEST(AnswerText, IsMarkedForItsReader) {
  const std::vector<Answer> answers = {{"Fast enough", ": a.", Ruling::kFastEnough},
                                       {"Not fast enough", ": b.", Ruling::kNotFastEnough},
                                       {"No answer", ": c.", Ruling::kSetUpFailed}};
  EXPECT_EQ(answer_text(answers, {"Type `x`."}, Markup::kPlain),
            "Fast enough: a.\nNot fast enough: b.\nNo answer: c.\n  → Type x.\n\n");
  EXPECT_EQ(
      answer_text(answers, {"Type `x`."}, Markup::kMarkdown),
      "**Fast enough**: a.\n\n**Not fast enough**: b.\n\n**No answer**: c.\n\n- Type `x`.\n\n");
  EXPECT_EQ(answer_text(answers, {}, Markup::kTerminal),
            "\x1b[1;32mFast enough\x1b[0m: a.\n"
            "\x1b[1;31mNot fast enough\x1b[0m: b.\n"
            "\x1b[1;33mNo answer\x1b[0m: c.\n\n");
}

}  // namespace
}  // namespace tether::report
