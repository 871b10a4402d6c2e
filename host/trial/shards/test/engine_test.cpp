#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/shards/engine_flights.h>

namespace tether::shards {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class EngineTest : public testing::Test {
 protected:
  Engine load(const std::string& text) { return load_engine(scratch_.write("engine.toml", text)); }

  ScratchFolder scratch_;
  const EngineCall call_{
      .name = "tether-1", .folder = "/a b", .script = "/s", .shards = 3, .cores = 2};
};

TEST_F(EngineTest, FillsInNamesAndLeavesOtherBraces) {
  Engine engine = load(R"(
    command = ["run", "{shards}x{cores} {script}{folder}", "${HOME} {} { name } {a-b} {name}", "{o}"]
    input = "{name}"
    [[option]]
    name = "o"
    value = "{name} stays"
  )");
  EXPECT_EQ(engine.shards, 1u);
  EXPECT_TRUE(engine.gives_cores());
  EXPECT_THAT(
      filled(engine.command, engine, call_),
      ElementsAre("run", "3x2 /s'/a b'", "${HOME} {} { name } {a-b} tether-1", "{name} stays"));
  EXPECT_EQ(filled(engine.input, engine, call_), "tether-1");
  set_options(engine, {"o=a=b"});
  EXPECT_EQ(filled(engine.command, engine, call_).back(), "a=b");
  for (const char* setting : {"o", "p=1", "=", ""})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { set_options(engine, {setting}); }).subject(),
              "--engine-option")
        << setting;
}

TEST_F(EngineTest, RefusesWhatItDoesNotKnow) {
  const auto expect_refused = [&](const std::string& text, const std::string& why, int line) {
    const Error error = bad_file_error([&] { load(text); });
    EXPECT_THAT(error.what(), HasSubstr(why));
    EXPECT_EQ(error.where().line, line) << text;
  };
  expect_refused("shards = 2\n", "lacks the key 'command'", 0);
  expect_refused("command = []\n", "command", 1);
  expect_refused("command = [\"{shard}\"]\n", "did you mean 'shards'", 1);
  expect_refused("command = [\"a\"]\ninput = \"{x_y}\"\n", "{x_y}", 2);
  expect_refused("command = [\"a\"]\ncancel = [\"{none}\"]\n", "{none}", 2);
  expect_refused("command = [\"a\"]\nshards = 0\n", "shards", 2);
  expect_refused("command = [\"a\"]\nworkers = 1\n", "unknown key 'workers'", 2);
}

TEST_F(EngineTest, ShippedOnesCanBeRead) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TETHER_SOURCE_DIR) + "/data/engines")) {
    const Engine engine = load_engine(entry.path());
    for (const std::string& word : filled(engine.command, engine, call_))
      EXPECT_EQ(word.find("{shards}"), std::string::npos);
    ++count;
  }
  EXPECT_EQ(count, 4);
}

}  // namespace
}  // namespace tether::shards
