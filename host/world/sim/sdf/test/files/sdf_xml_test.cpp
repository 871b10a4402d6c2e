#include "sdf_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Unreadable {
  std::string text;
  int line;
  const char* words;
};

TEST(SdfXml, SaysInWordsWhatIsWrong) {
  const std::string head = "<sdf version='1.7'>\n<world name='w'>\n", tail = "</world>\n</sdf>\n";
  const Unreadable cases[] = {
      {head + "<model name='m'>\n" + tail, 3, "<model> is not closed by a tag of the same name"},
      {head + "<model name=m/>\n" + tail, 3, "name=\"value\""},
      {head + "<!-- open\n" + tail, 3, "the comment is not closed"},
      {head + "<![CDATA[ open\n" + tail, 3, "add ]]>"},
      {"<html/>", 1, "it must be <sdf>"},
      {"", 0, "has no element"},
      {"\xff\xfe<\0s\0d\0f\0", 1, "Save it as UTF-8"},
      {std::string("\0<\0s\0d\0f", 8), 1, "Save it as UTF-8"},
      {head + "<!-- gr\xfc\xdf\n-->\n<model name='gr\xfcn'/>\n" + tail, 5, "Latin-1"},
      {head + "<model name='cut \xc3'/>\n" + tail, 3, "not UTF-8"},
      {head + "<model name='long \xf5\x80\x80\x80'/>\n" + tail, 3, "not UTF-8"},
  };
  const ScratchFolder folder;
  for (const Unreadable& given : cases) {
    const auto file = folder.write("w.sdf", given.text);
    const Error error = refusal({file, {}, {}});
    EXPECT_EQ(error.where(), (FileLocation{file.string(), given.line})) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(given.words));
    EXPECT_THAT(error.what(), Not(HasSubstr("XML_")));
  }
}

TEST(SdfXml, ReadsUtf8AndCommentsInAnyEncoding) {
  const Loaded loaded = load_content(
      "<!-- gr\xfcn -->\n<model name='gr\xc3\xbcn \xe2\x82\xac \xf0\x9f\x9a\x81'>"
      "<static>true</static><link name='l'/></model>");
  EXPECT_EQ(loaded.world.models.at(0).name, "gr\xc3\xbcn \xe2\x82\xac \xf0\x9f\x9a\x81");
}

}  // namespace
}  // namespace tether::sim
