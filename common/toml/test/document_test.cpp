#include <functional>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/toml/table.h>

namespace tether::toml {
namespace {

TEST(Document, NamesTheLineOfASyntaxError) {
  const Error error = bad_file_error([] { Document::parse("a = 1\nb = [\n", "f.toml"); });
  EXPECT_EQ(error.where(), (FileLocation{"f.toml", 2}));
}

TEST(Document, IsReadFromARegularFile) {
  const ScratchFolder folder;
  const auto file = folder.write("a/f.toml", "k = \"f.toml\"\n");
  const Document document = Document::load(file);
  EXPECT_EQ(document.root({"k"}).existing_file("k"), file);
}

TEST(Document, RefusesAFileThatCannotBeRead) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("pipe").c_str(), 0600), 0);
  const auto large = folder.write("large", "");
  std::filesystem::resize_file(large, (1U << 20) + 1);
  for (const auto& file : {folder.path("gone"), folder.path("pipe"), folder.path(), large})
    EXPECT_EQ(bad_file_error([&] { Document::load(file); }).where().file, file);
  EXPECT_THAT(bad_file_error([&] { Document::load(large); }).what(), testing::HasSubstr("1048577"));
  EXPECT_THAT(bad_file_error([] { Document::load("/proc/self/exe"); }).what(),
              testing::HasSubstr("is a program, not a TOML file"));
}

TEST(Document, ReplacesAValueWhereverThePathNamesOne) {
  const std::string text =
      "a = 1\n[b]\nc = 2.5\n[[d]]\ne = \"x\"\n[[d]]\nf = 3\n[[d]]\ne = \"y\"\n";
  struct Case {
    const char *path, *value;
    std::size_t replaced;
    std::function<bool(const Table&)> is_there;
  };
  const Case cases[] = {
      {"a", "7", 1, [](const Table& t) { return t.integer("a", 0, 9) == 7; }},
      {"b.c", "-0.5", 1, [](const Table& t) { return t.table("b").number("c", {}) == -0.5; }},
      {"b.c", "true", 1, [](const Table& t) { return t.table("b").boolean("c"); }},
      {"b.c", "1979-05-27", 1,
       [](const Table& t) { return t.table("b").text("c") == "1979-05-27"; }},
      {"b.c", "1\nz = 2", 1,
       [](const Table& t) { return t.table("b").text("c") == "1\nz = 2" && !t.has("z"); }},
      {"d.e", "new file.toml", 2,
       [](const Table& t) {
         const auto d = t.tables("d");
         return d[0].text("e") == "new file.toml" && d[2].text("e") == "new file.toml" &&
                d[1].integer("f", 0, 9) == 3;
       }},
      {"a", "[1, 2]", 1, [](const Table& t) { return t.numbers("a", {}).size() == 2; }},
      {"b", "1", 0, [](const Table& t) { return t.is_table("b"); }},
      {"b.x", "1", 0, [](const Table& t) { return !t.table("b").has("x"); }},
      {"a.b", "1", 0, [](const Table& t) { return t.integer("a", 0, 9) == 1; }},
      {"", "1", 0, [](const Table& t) { return t.integer("a", 0, 9) == 1; }},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.path) + " = " + c.value);
    Document document = Document::parse(text, "f.toml");
    EXPECT_EQ(document.replace(c.path, c.value), c.replaced);
    EXPECT_TRUE(c.is_there(document.root()));
  }
}

TEST(Document, AddsAValueWhereThereIsNone) {
  Document document = Document::parse("a = 1\n[[c]]\nd = 2\n[[c]]\n", "f.toml");
  EXPECT_EQ(document.add("a", "5"), 0u);
  EXPECT_EQ(document.add("a.b", "5"), 0u);
  EXPECT_EQ(document.add("c.d", "3"), 1u);
  EXPECT_EQ(document.add("b.e", "[1, 2]"), 1u);
  EXPECT_EQ(document.root().integer("a", 0, 9), 1);
  EXPECT_EQ(document.root().tables("c")[0].integer("d", 0, 9), 2);
  EXPECT_EQ(document.root().tables("c")[1].integer("d", 0, 9), 3);
  EXPECT_EQ(document.root().table("b").numbers("e", {}).size(), 2u);
  const Error error =
      bad_file_error([&] { (void)document.root().tables("c")[1].number("d", {.min = 4.0}); });
  EXPECT_EQ(error.where().line, 0) << "the file has no such line";
}

TEST(Document, PlacesMistakesInAReplacedValueAtItsKey) {
  Document document = Document::parse("a = 1\n\nb = 2\n", "f.toml");
  document.replace("b", "-3");
  const Error error = bad_file_error([&] { (void)document.root().number("b", {.min = 0.0}); });
  EXPECT_EQ(error.where().line, 3);
  EXPECT_EQ(error.subject(), "b");
}

TEST(PlaceOf, IsTheLineOfAKeyThatTheFileHasOnce) {
  const ScratchFolder scratch;
  const auto file = scratch.write("f.toml", "a = 1\n[[t]]\nb = 2\nc = 3\n[[t]]\nc = 4\n");
  EXPECT_EQ(place_of(file, "b"), (FileLocation{file.string(), 3}));
  EXPECT_EQ(place_of(file, "c"), FileLocation{file.string()});
  EXPECT_EQ(place_of(file, "d"), FileLocation{file.string()});
  EXPECT_EQ(place_of("/gone", "a"), FileLocation{"/gone"});
}

}  // namespace
}  // namespace tether::toml
