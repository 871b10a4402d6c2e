// Properties of every key of every kind of file: each full file is changed at one key at a time.
#include "test_files.h"

#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/campaign.h>

namespace tether::scenario {
namespace {

struct KeyLine {
  int line = 0;    // 1-based
  int header = 0;  // line of the table it is in; 0: the top of the file
  std::string key;
  std::string value;
  bool is_parameter = false;  // of a table whose keys are free
};

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Every line "key = value".
std::vector<KeyLine> key_lines(const std::string& text) {
  std::vector<KeyLine> keys;
  int number = 0, header = 0;
  bool is_free = false;
  for (const std::string& line : lines_of(text)) {
    ++number;
    if (line.starts_with("[")) {
      header = number;
      is_free = line.ends_with("sut.parameters]") || line.ends_with("sut.files]");
    } else if (const auto equals = line.find(" = "); equals != std::string::npos) {
      keys.push_back({number, header, line.substr(0, equals), line.substr(equals + 3), is_free});
    }
  }
  return keys;
}

/// The text with another line in place of that one.
std::string with_line(const std::string& text, int number, const std::string& other) {
  std::string all;
  int at = 0;
  for (const std::string& line : lines_of(text)) all += (++at == number ? other : line) + "\n";
  return all;
}

struct FileKind {
  std::string name;
  std::string text;
  void (*load)(const std::filesystem::path&);
  int required_keys;
};

void PrintTo(const FileKind& kind, std::ostream* out) {
  *out << kind.name;
}

class FileKeys : public testing::TestWithParam<FileKind> {
 protected:
  FileKeys() { write_project(scratch_, kFullScenario); }
  /// The text with another line in place of that of the key.
  void load_with(const KeyLine& key, const std::string& line) const {
    load(with_line(GetParam().text, key.line, line));
  }
  void load(const std::string& text) const {
    GetParam().load(scratch_.write(GetParam().name + ".toml", text));
  }

  ScratchFolder scratch_;
  const std::vector<KeyLine> keys_ = key_lines(GetParam().text);
};

TEST_P(FileKeys, RefusesAMisspelledKeyAndAValueOfTheWrongTypeAtItsLine) {
  for (const KeyLine& key : keys_) {
    expect_refusal(key.line, key.key, [&] { load_with(key, key.key + " = 1979-05-27"); });
    if (key.is_parameter) continue;
    expect_refusal(key.line, key.key + "q", [&] { load_with(key, key.key + "q = " + key.value); });
  }
}

TEST_P(FileKeys, RefusesANumberOutOfAnyRangeAtItsLine) {
  for (const KeyLine& key : keys_) {
    const bool is_number = key.value.find_first_not_of("-0123456789.") == std::string::npos;
    if (!is_number || key.is_parameter) continue;
    for (const std::string value : {"inf", "nan", "-1e300", "1e300"})
      expect_refusal(key.line, key.key, [&] { load_with(key, key.key + " = " + value); });
  }
}

// ('anchors' is not required itself: without it, the metric that names one of them is wrong.)
TEST_P(FileKeys, RefusesAMissingKeyAtItsTable) {
  int required_keys = 0;
  for (const KeyLine& key : keys_) {
    if (key.key == "anchors") continue;
    try {
      load_with(key, "");
    } catch (const Error& error) {
      ++required_keys;
      EXPECT_EQ(error.where().line, key.header) << error.what();
      EXPECT_THAT(error.what(), testing::HasSubstr("'" + key.key + "'"));
    }
  }
  EXPECT_EQ(required_keys, GetParam().required_keys);
}

TEST_P(FileKeys, LoadsOrRefusesAFileCutAnywhere) {
  for (std::size_t size = 0; size < GetParam().text.size(); size += 7) {
    try {
      load(GetParam().text.substr(0, size));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Of, FileKeys,
    testing::Values(
        FileKind{"scenario", kFullScenario, [](const auto& file) { load_scenario(file); }, 36},
        FileKind{"campaign", kFullCampaign, [](const auto& file) { load_campaign(file); }, 3},
        FileKind{"profile", kFullProfile, [](const auto& file) { load_profile(file); }, 9},
        FileKind{"target", kFullTarget, [](const auto& file) { load_target(file); }, 1},
        FileKind{"board", kBoardTarget, [](const auto& file) { load_target(file); }, 1}),
    [](const auto& kind) { return kind.param.name; });

}  // namespace
}  // namespace tether::scenario
