#include <array>
#include <fstream>
#include <functional>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/toml/table.h>

namespace tether::toml {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// What `read` says of the file "f.toml" with this text.
template <class Read>
auto of(const std::string& text, Read read) {
  return read(Document::parse(text, "f.toml").root());
}

std::string error_of(const std::string& text, const std::function<void(const Table&)>& read) {
  try {
    of(text, read);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    return error.what();
  }
  return "no error";
}

// Keys and places ---------------------------------------------------------------------------------

TEST(Table, NamesWhatItHas) {
  const Document file = Document::parse("b = 1\na = 2\n[c]\nd = 3\n", "f.toml");
  const Table root = file.root({"a", "b", "c"});
  EXPECT_TRUE(root.has("a"));
  EXPECT_FALSE(root.has("d"));
  EXPECT_THAT(root.keys(), ElementsAre("a", "b", "c"));
  EXPECT_EQ(root.title(), "the file");
  EXPECT_EQ(root.where().line, 0);
  EXPECT_EQ(root.where("a").line, 2);
  EXPECT_EQ(root.table("c").title(), "[c]");
  EXPECT_EQ(root.table("c").where().line, 3);
}

TEST(Table, RefusesUnknownKeysWithASuggestion) {
  EXPECT_EQ(error_of("[a]\nrate = 1\n", [](const Table& t) { (void)t.table("a", {"rate_hz"}); }),
            "f.toml:2: unknown key 'rate' in [a]; did you mean 'rate_hz'? Allowed: 'rate_hz'");
  EXPECT_THAT(error_of("x = 1\n", [](const Table& t) { (void)t.tables("x", {"y"}); }),
              StartsWith("f.toml:1: 'x' of the file must be one or more tables [[x]], but is the "
                         "integer 1"));
  EXPECT_THAT(
      error_of("[[x]]\ny = 1\n[[x]]\nz = 1\n", [](const Table& t) { (void)t.tables("x", {"y"}); }),
      StartsWith("f.toml:4: unknown key 'z' in [x]"));
}

TEST(Table, NamesTheHeaderOfATableThatLacksAKey) {
  EXPECT_EQ(error_of("\n[a.b]\n", [](const Table& t) { (void)t.table("a").table("b").text("k"); }),
            "f.toml:2: [a.b] lacks the key 'k'");
  EXPECT_EQ(error_of("", [](const Table& t) { (void)t.text("k"); }),
            "f.toml: the file lacks the key 'k'");
}

// Values ------------------------------------------------------------------------------------------

TEST(Table, ReadsValues) {
  const Document file = Document::parse(
      "text = \"a b\"\nempty = \"\"\nid = \"a-1\"\nnumber = 2.5\ninteger = -3\nyes = true\n"
      "wait_ms = 20\nword = \"two\"\npair = [1, 2.5]\nwords = [\"a\", \"b\"]\nseeds = [1, 2]\n",
      "f.toml");
  const Table root = file.root();
  EXPECT_EQ(root.text("text"), "a b");
  EXPECT_EQ(root.any_text("empty"), "");
  EXPECT_EQ(root.identifier("id"), "a-1");
  EXPECT_EQ(root.number("number", {}), 2.5);
  EXPECT_EQ(root.number("integer", {}), -3.0);
  EXPECT_EQ(root.integer("integer", -3, 3), -3);
  EXPECT_TRUE(root.boolean("yes"));
  EXPECT_EQ(root.duration("wait_ms", {}), 20ms);
  EXPECT_EQ(root.choice("word", std::array<std::string_view, 2>{"one", "two"}), 1u);
  EXPECT_THAT(root.numbers("pair", 2, {}), ElementsAre(1.0, 2.5));
  EXPECT_THAT(root.numbers("pair", {.min = 1.0}), ElementsAre(1.0, 2.5));
  EXPECT_THAT(root.texts("words"), ElementsAre("a", "b"));
  EXPECT_THAT(root.integers("seeds", 1), ElementsAre(1, 2));
  for (const auto& [key, text] :
       {std::pair{"text", "a b"}, {"number", "2.5"}, {"integer", "-3"}, {"yes", "true"}}) {
    EXPECT_EQ(root.scalar_as_text(key), text);
  }
}

TEST(Table, ReadsWhatMayBeMissing) {
  const Document file = Document::parse("", "f.toml");
  const Table root = file.root();
  EXPECT_EQ(root.text_or("k", "x"), "x");
  EXPECT_EQ(root.number_or("k", {}, 1.5), 1.5);
  EXPECT_EQ(root.number_if("k", {}), std::nullopt);
  EXPECT_EQ(root.integer_or("k", 0, 1, 7), 7);
  EXPECT_EQ(root.duration_or("k_s", {}, 3s), 3s);
  EXPECT_TRUE(root.boolean_or("k", true));
  EXPECT_THAT(root.texts_or_none("k"), IsEmpty());
  EXPECT_TRUE(root.tables_or_none("k", {}).empty());
}

struct Mistake {
  const char* value;
  std::function<void(const Table&)> read;
  const char* says;
};

TEST(Table, NamesWhatIsWrongWithAValue) {
  const std::vector<Mistake> mistakes = {
      {"1", [](auto& t) { t.text("k"); }, "must be a string, but is the integer 1"},
      {"\"\"", [](auto& t) { t.text("k"); }, "must not be empty"},
      {"\"\\u0000\"", [](auto& t) { t.text("k"); }, "must not contain a NUL character"},
      {"\".a\"", [](auto& t) { t.identifier("k"); }, "must be 1 to 64 letters, digits"},
      {"\"a\"", [](auto& t) { t.number("k", {}); }, "must be a number, but is the string \"a\""},
      {"nan", [](auto& t) { t.number("k", {}); }, "must be finite, but is nan"},
      {"5.5", [](auto& t) { t.number("k", {.min = 0.0, .max = 5.0}); },
       "must be at least 0 and at most 5, but is 5.5"},
      {"0",
       [](auto& t) {
         t.number("k", {.min = 0.0, .max = 180.0, .above_min = true, .below_max = true});
       },
       "must be greater than 0 and less than 180, but is 0"},
      {"1.0", [](auto& t) { t.integer("k", 0, 1); }, "must be an integer, but is the number 1"},
      {"2", [](auto& t) { t.integer("k", 0, 1); }, "must be at least 0 and at most 1, but is 2"},
      {"1", [](auto& t) { t.boolean("k"); }, "must be true or false, but is the integer 1"},
      {"\"red\"", [](auto& t) { t.choice("k", std::array<std::string_view, 1>{"rod"}); },
       "is \"red\"; did you mean 'rod'? Allowed: 'rod'"},
      {"[1]", [](auto& t) { t.scalar_as_text("k"); },
       "must be a string, a number or a boolean, but is an array"},
      {"[1]", [](auto& t) { t.numbers("k", 2, {}); },
       "must be an array of 2 numbers, but has 1 elements"},
      {"[1, true]", [](auto& t) { t.numbers("k", 2, {}); },
       "must be a number, but is the boolean true"},
      {"[]", [](auto& t) { t.numbers("k", {}); }, "must hold at least one number, but is empty"},
      {"[-1]", [](auto& t) { t.numbers("k", {.min = 0.0}); },
       "must be numbers of at least 0, but has the integer -1"},
      {"[0]", [](auto& t) { t.integers("k", 1); }, "must be integers of at least 1, but has 0"},
      {"[1.5]", [](auto& t) { t.integers("k", 1); },
       "must be an array of integers only, but is the number 1.5"},
      {"[\"\"]", [](auto& t) { t.texts("k"); }, "must not contain an empty string"},
      {"[1]", [](auto& t) { t.texts("k"); },
       "must be an array of strings only, but is the integer 1"},
      {"1979-05-27", [](auto& t) { t.table("k"); }, "must be a table, but is a date or time"},
      {"[]", [](auto& t) { t.tables("k", {}); },
       "must be one or more tables [[k]], but is an empty array"},
      {"[1]", [](auto& t) { t.tables("k", {}); },
       "must be one or more tables [[k]], but is the integer 1"},
      {"\"gone\"", [](auto& t) { t.existing_file("k"); },
       "names \"gone\", but there is no such file (gone)"},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string text = std::string("\nk = ") + mistake.value + "\n";
    EXPECT_THAT(error_of(text, mistake.read),
                StartsWith(std::string("f.toml:2: 'k' of the file ") + mistake.says));
  }
}

TEST(Table, NamesTheLineOfAWrongElement) {
  EXPECT_THAT(error_of("k = [\n1,\n-2]\n", [](auto& t) { t.numbers("k", {.min = 0.0}); }),
              StartsWith("f.toml:3: "));
}

// Files -------------------------------------------------------------------------------------------

TEST(Document, NamesTheLineThatIsNoToml) {
  EXPECT_THAT(error_of("a = 1\nb = [\n", [](const Table&) {}),
              StartsWith("f.toml:2: no valid TOML: "));
}

TEST(Document, IsReadFromARegularFile) {
  const ScratchFolder folder;
  const auto file = folder.write("a/f.toml", "k = \"f.toml\"\n");
  const Document document = Document::load(file);
  EXPECT_EQ(document.root({"k"}).existing_file("k"), file);
}

std::string load_error(const std::filesystem::path& file) {
  const auto loaded = result_of([&] { return Document::load(file).root().keys(); });
  EXPECT_FALSE(loaded);
  return loaded ? "" : loaded.failure().message;
}

TEST(Document, SaysWhyAFileCannotBeRead) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo(folder.path("pipe").c_str(), 0600), 0);
  const auto large = folder.write("large", "");
  std::filesystem::resize_file(large, (1U << 20) + 1);
  const std::string at = folder.path().string();
  EXPECT_EQ(load_error(folder.path("gone")), at + "/gone: there is no such file");
  EXPECT_EQ(load_error(folder.path("pipe")), at + "/pipe: that is no regular file");
  EXPECT_EQ(load_error(folder.path()), at + ": that is no regular file");
  EXPECT_EQ(load_error(large), at + "/large: is 1048577 bytes long; at most 1048576 are read");
}

TEST(ResultOf, IsAValueOrTheFailureOfWhatWasThrown) {
  const auto number = [](const std::string& text) {
    return result_of([&] { return Document::parse(text, "f.toml").root().number("k", {}); });
  };
  EXPECT_EQ(number("k = 1.5").value(), 1.5);
  EXPECT_EQ(number("k = true").failure().kind, Failure::Kind::kInvalid);
  EXPECT_EQ(number("k = true").failure().message,
            "f.toml:1: 'k' of the file must be a number, but is the boolean true");
}

}  // namespace
}  // namespace tether::toml
