#include <array>
#include <functional>

#include <gmock/gmock.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/toml/table.h>

namespace tether::toml {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

/// The error of reading the file "f.toml" with this text.
Error error_of(const std::string& text, const std::function<void(const Table&)>& read) {
  return bad_file_error([&] { read(Document::parse(text, "f.toml").root()); });
}

void expect_error(const std::string& text, const std::function<void(const Table&)>& read, int line,
                  const std::string& subject) {
  const Error error = error_of(text, read);
  EXPECT_EQ(error.where().file, "f.toml");
  EXPECT_EQ(error.where().line, line) << error.what();
  EXPECT_EQ(error.subject(), subject) << error.what();
}

// Keys and places ---------------------------------------------------------------------------------

TEST(Table, HasKeysAndPlaces) {
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

TEST(Table, RefusesUnknownAndMissingKeys) {
  const auto keys_of_x = [](const Table& t) { (void)t.tables("x", {"y"}); };
  EXPECT_STREQ(
      error_of("[a]\nrate = 1\n", [](const Table& t) { (void)t.table("a", {"rate_hz"}); }).what(),
      "f.toml:2: unknown key 'rate' in [a]; did you mean 'rate_hz'? Allowed: 'rate_hz'");
  expect_error("[[x]]\ny = 1\n[[x]]\nz = 1\n", keys_of_x, 4, "z");
  expect_error("\n[x]\ny = 1\n", keys_of_x, 2, "x");
  // The header of the table that lacks the key.
  expect_error(
      "\n[a.b]\n", [](const Table& t) { (void)t.table("a").table("b").text("k"); }, 2, "k");
  expect_error(
      "", [](const Table& t) { (void)t.text("k"); }, 0, "k");
}

TEST(Table, NamesTheTableBelowThatHasAMissingKey) {
  const auto key_of_uav = [](const Table& t) { (void)t.tables("uav").front().text("key"); };
  EXPECT_STREQ(
      error_of("[[uav]]\n[uav.sensors.camera]\nkey = 1\n", key_of_uav).what(),
      "f.toml:1: [uav] lacks the key 'key'; line 3 has it in [uav.sensors.camera]. Write it "
      "above [uav.sensors.camera]");
  EXPECT_STREQ(error_of("[[uav]]\n[uav.sensors]\n[[uav]]\nkey = 1\n", key_of_uav).what(),
               "f.toml:1: [uav] lacks the key 'key'");
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

TEST(Table, NamesTheLineAndTheKeyOfAWrongValue) {
  constexpr Range kAngle{.min = 0.0, .max = 180.0, .above_min = true, .below_max = true};
  constexpr std::array<std::string_view, 1> kWords{"rod"};
  const std::vector<std::pair<const char*, std::function<void(const Table&)>>> mistakes = {
      {"1", [](auto& t) { t.text("k"); }},
      {"\"\"", [](auto& t) { t.text("k"); }},
      {"\"\\u0000\"", [](auto& t) { t.text("k"); }},
      {"\".a\"", [](auto& t) { t.identifier("k"); }},
      {"\"a\"", [](auto& t) { t.number("k", {}); }},
      {"nan", [](auto& t) { t.number("k", {}); }},
      {"5.5", [](auto& t) { t.number("k", {.min = 0.0, .max = 5.0}); }},
      {"0", [=](auto& t) { t.number("k", kAngle); }},
      {"1.0", [](auto& t) { t.integer("k", 0, 1); }},
      {"2", [](auto& t) { t.integer("k", 0, 1); }},
      {"1", [](auto& t) { t.boolean("k"); }},
      {"\"red\"", [=](auto& t) { t.choice("k", kWords); }},
      {"[1]", [](auto& t) { t.scalar_as_text("k"); }},
      {"[1]", [](auto& t) { t.numbers("k", 2, {}); }},
      {"[1, true]", [](auto& t) { t.numbers("k", 2, {}); }},
      {"[]", [](auto& t) { t.numbers("k", {}); }},
      {"[-1]", [](auto& t) { t.numbers("k", {.min = 0.0}); }},
      {"[0]", [](auto& t) { t.integers("k", 1); }},
      {"[1.5]", [](auto& t) { t.integers("k", 1); }},
      {"[\"\"]", [](auto& t) { t.texts("k"); }},
      {"[1]", [](auto& t) { t.texts("k"); }},
      {"1979-05-27", [](auto& t) { t.table("k"); }},
      {"1", [](auto& t) { t.tables("k"); }},
      {"[]", [](auto& t) { t.tables("k", {}); }},
      {"[1]", [](auto& t) { t.tables("k", {}); }},
      {"\"gone\"", [](auto& t) { t.existing_file("k"); }},
  };
  for (const auto& [value, read] : mistakes) {
    SCOPED_TRACE(value);
    expect_error(std::string("\nk = ") + value + "\n", read, 2, "k");
  }
  expect_error(
      "k = [\n1,\n-2]\n", [](auto& t) { t.numbers("k", {.min = 0.0}); }, 3, "k");
}

TEST(Table, SaysWhatWasFoundAndWhatIsAllowed) {
  const auto message = [](const char* value, const Range& range) {
    return std::string(error_of(std::string("[a]\nk = ") + value, [&](auto& t) {
                         t.table("a").number("k", range);
                       }).what());
  };
  const std::string at = "f.toml:2: 'k' of [a] must be ";
  EXPECT_EQ(message("\"b\"", {}), at + "a number, but is the string \"b\"");
  EXPECT_EQ(message("nan", {}), at + "finite, but is nan");
  EXPECT_EQ(message("5.5", {.min = 0.0, .max = 5.0}), at + "at least 0 and at most 5, but is 5.5");
  EXPECT_EQ(message("0", {.min = 0.0, .max = 9.0, .above_min = true, .below_max = true}),
            at + "greater than 0 and less than 9, but is 0");
  EXPECT_EQ(message("-inf", {.min = 0.0, .with_inf = true}),
            at + "at least 0, or inf, but is -inf");
}

TEST(Table, ReadsScalarsOfAnArrayAsOnACommandLine) {
  const Document file = Document::parse("a = [1, 2.5, true, \"x\"]\nb = []\nc = [[1]]\n", "f.toml");
  EXPECT_THAT(file.root().scalars_as_texts("a"), ElementsAre("1", "2.5", "true", "x"));
  for (const char* key : {"b", "c"})
    EXPECT_EQ(bad_file_error([&] { (void)file.root().scalars_as_texts(key); }).subject(), key);
  EXPECT_THAT(bad_file_error([&] { (void)file.root().scalars_as_texts("c"); }).what(),
              testing::HasSubstr("numbers or booleans, not of arrays, but is an array"));
}

TEST(ResultOf, IsAValueOrTheFailureOfWhatWasThrown) {
  const auto number = [](const std::string& text) {
    return result_of([&] { return Document::parse(text, "f.toml").root().number("k", {}); });
  };
  EXPECT_EQ(number("k = 1.5").value(), 1.5);
  EXPECT_EQ(number("k = true").failure().kind, Failure::Kind::kInvalid);
}

}  // namespace
}  // namespace tether::toml
