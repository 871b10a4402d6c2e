#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/toml/table.h>

namespace tether::toml {
namespace {

using testing::HasSubstr;

using namespace std::string_literals;

TEST(SyntaxError, SaysWhatToWriteAndWhere) {
  struct Case {
    std::string text;
    int line;
    const char* advice;
  };
  for (const auto& [text, line, advice] : {
           Case{"\na = \"abc\nb = 1", 2, "the string is not closed"},
           Case{"a = 'abc\nb = 1", 1, "the string is not closed"},
           Case{"a = \"\"\"x\n", 1, "the string is not closed"},
           Case{"a = \"x\x01\"", 1, "control character"},
           Case{"a = \"C:\\xy\"", 1, "'\\\\' for each backslash"},
           Case{"a = \xe2\x80\x9c"
                "abc\xe2\x80\x9d",
                1, "straight quotes"},
           Case{"a = 1\r\nyaw_rad = 1.57rad  # east\r\n", 2,
                "'1.57' is followed by 'rad'. Write the number"},
           Case{"a = 10 %", 1, "'10' is followed by '%'"},
           Case{"a = 12345678901234567890123", 1, "largest whole number is 9223372036854775807"},
           Case{"a = 1e999", 1, "largest is about 1.8e308"},
           Case{"a = 1,5", 1, "Write 1.5"},
           Case{"a = -.5", 1, "Write -0.5"},
           Case{"a = 5.", 1, "Write 5.0"},
           Case{"a = 05", 1, "must not begin with 0"},
           Case{"a = hello", 1, "in quotes: \"hello\""},
           Case{"a = True", 1, "Write true or false"},
           Case{"a = yes # really", 1, "Write true or false"},
           Case{"a =\nb = 1", 1, "'a' has no value"},
           Case{"a: 5", 1, "Write a = 5"},
           Case{"a b = 5", 1, "no '=' after the key"},
           Case{"a = 1\na = 2", 2, "the key 'a' is there twice"},
           Case{"a = true\na = false", 2, "the key 'a' is there twice"},
           Case{"[u]\nx = 1\n[u]\n", 3, "write [[u]] each time"},
           Case{"[[u]]\nx = 1\n[u]\n", 3, "Write [[u]]"},
           Case{"[[u]\n", 1, "the header '[[u]' is not complete"},
           Case{"a = [1 2]", 1, "lacks a comma"},
           Case{"a = {\nx = 1}", 1, "on one line"},
           Case{"a = 1 b = 2", 1, "each key on a line of its own"},
           Case{"a = 1 // one", 1, "begin with '#'"},
           Case{"<sdf/>", 1, "this is XML"},
           Case{"a = 1\nb = \"M\xfcller\"", 2, "Save the file as UTF-8"},
           Case{"\xff\xfe"
                "a\0=\0"s,
                1, "UTF-16"},
           Case{"a\0=\0"s, 1, "UTF-16"},
           Case{"a = \"x\0\""s, 1, "not a text file"},
           Case{"a = 2026-13-45", 1, "not valid TOML: "},
       }) {
    const Error error = bad_file_error([&text = text] { Document::parse(text, "f.toml"); });
    EXPECT_EQ(error.where().line, line) << text;
    EXPECT_THAT(error.what(), HasSubstr(advice)) << text;
  }
}

TEST(SyntaxError, AcceptsAByteOrderMarkAndWindowsLineEnds) {
  const Document document = Document::parse(
      "\xef\xbb\xbf"
      "a = 1\r\nb = 2\r\n",
      "f.toml");
  EXPECT_EQ(document.root().integer("b", 0, 5), 2);
}

TEST(SyntaxError, ReadsLinesOfAnyLength) {
  bad_file_error([] { Document::parse("a = " + std::string(1 << 19, 'x'), "f.toml"); });
}

}  // namespace
}  // namespace tether::toml
