#include "code_scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::layout {
namespace {

using testing::ElementsAre;

std::vector<std::string> names(std::string_view source) {
  std::vector<std::string> out;
  for (const Function& function : functions(source)) out.push_back(function.name);
  return out;
}

TEST(Strip, BlanksCommentsAndKeepsLines) {
  EXPECT_EQ(strip("a; // b\nc; /* d\ne */ f;"), "a;     \nc;     \n     f;");
}

TEST(Strip, BlanksLiteralsWithTheirEscapes) {
  EXPECT_EQ(strip(R"(f("a\"{", '{', '\'');)"), R"(f("    ", ' ', '  ');)");
  EXPECT_EQ(strip("f(u8\"{\", L'{');"), "f(u8\" \", L' ');");
}

TEST(Strip, KnowsDigitSeparators) {
  EXPECT_EQ(strip("x = 1'000'000; y = 0xF'F; // z"), "x = 1'000'000; y = 0xF'F;     ");
}

TEST(Strip, BlanksRawStrings) {
  EXPECT_EQ(strip("x = R\"a(\" { )\" )a\"; y"), "x =               ; y");
}

TEST(Includes, FindsBothKindsAndSkipsComments) {
  const auto found = includes(
      "#include <a/b.h>\n// #include <no.h>\n#  include \"c.h\"  // why\n/*\n#include <d>\n*/\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].path, "a/b.h");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].path, "c.h");
  EXPECT_TRUE(found[1].quoted);
  EXPECT_EQ(found[1].line, 3);
}

TEST(Functions, MeasuresFromBraceToBrace) {
  const auto found = functions(
      "int f() { return 1; }\n\nvoid g(int a,\n       int b) {\n  if (a) {\n    b = {};\n  }\n}\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].length, 1);
  EXPECT_EQ(found[1].name, "g");
  EXPECT_EQ(found[1].line, 4);
  EXPECT_EQ(found[1].length, 5);
}

TEST(Functions, AreFoundInEveryScopeAndNothingElseIs) {
  EXPECT_THAT(names(R"(#define X(a) { \
  a
namespace a::b {
constexpr int kTable[] = {1, 2};
const std::map<int, B> kMap = {
    {1, make(2)},
};
template <class T>
class C final : public D {
 public:
  C() : x_{0},
        y_(1) {}
  ~C() {}
  int f(A a = {}) const { return x_; }
  bool operator==(const C&) const { return true; }
  enum class E { kA };

 private:
  int x_{0};
  std::vector<int> y_ = {1, 2};
};
template <class T, class U = V<int>>
T g(U u) {
  return [] {
    return 1;
  };
}
C::C(int a)
    : a_{a}, b_(a) {
  X(1)
}
extern "C" {
int c();
}
}
)"),
              ElementsAre("C", "~C", "f", testing::_, "g", "C::C"));
}

TEST(LinesWithWord, NeedsWholeWords) {
  EXPECT_THAT(lines_with_word("sleep\nsleeper\n my_sleep x.sleep(\n", "sleep"), ElementsAre(1, 3));
}

TEST(CountLines, CountsAnUnfinishedLastLine) {
  EXPECT_EQ(count_lines(""), 0);
  EXPECT_EQ(count_lines("a\nb\n"), 2);
  EXPECT_EQ(count_lines("a\nb"), 2);
}

}  // namespace
}  // namespace tether::layout
