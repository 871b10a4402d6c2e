#include "code_scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::layout {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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

TEST(Functions, FindsMembersInNestedScopes) {
  EXPECT_THAT(names("namespace a::b {\nclass [[nodiscard]] C final : public D {\n public:\n  C() "
                    "{}\n  ~C() {}\n"
                    "  int f() const { return x_; }\n  auto g() -> int { return 1; }\n  enum class "
                    "E { kA };\n"
                    " private:\n  int x_{0};\n  std::vector<int> y_ = {1, 2};\n  void h() noexcept "
                    "{}\n};\n}\n"),
              ElementsAre("C", "~C", "f", "g", "h"));
}

TEST(Functions, KnowsConstructorsWithInitialisers) {
  EXPECT_THAT(names("C::C(int a) : a_{a}, b_(a), c_{} {\n}\nint D::f() { return 0; }\n"),
              ElementsAre("C::C", "D::f"));
}

TEST(Functions, KnowsTemplatesAndOperators) {
  EXPECT_THAT(names("template <class T, class U = V<int>>\nT f(U u) { return u; }\n"
                    "bool operator==(A a, A b) { return true; }\n"),
              ElementsAre("f", testing::_));
  EXPECT_EQ(names("struct F {\n  int operator()(int a) const { return a; }\n};\n").size(), 1u);
}

TEST(Functions, SkipsWhatIsNone) {
  EXPECT_THAT(
      names(
          "constexpr int kTable[] = {1, 2};\nstruct A { std::function<void()> f{}; int b = 0; };\n"
          "const std::map<int, B> kMap = {{1, make(2)}};\nextern \"C\" {\nint c();\n}\nenum D { e "
          "};\n"
          "struct G {\n  int a[2] = {};\n} g;\n"),
      IsEmpty());
}

TEST(Functions, IsNotConfusedByDefaultArgumentsAndMacros) {
  EXPECT_THAT(
      names("#define X(a) { \\\n  a\nvoid f(A a = {}, B b = B{1}) {\n  X(1)\n}\nvoid g() {}\n"),
      ElementsAre("f", "g"));
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
