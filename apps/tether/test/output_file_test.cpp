#include "options/output_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

namespace fs = std::filesystem;

constexpr OutputFormat kAll[] = {OutputFormat::kJunit, OutputFormat::kHtml, OutputFormat::kCsv,
                                 OutputFormat::kText, OutputFormat::kTiming};

class OutputFile : public testing::Test {
 protected:
  std::string refusal_of(const fs::path& file, OutputFormat format) const {
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { require_output_file("--csv", file, format); });
    EXPECT_EQ(error.subject(), "--csv");
    return error.what();
  }
  ScratchFolder scratch_;
};

TEST_F(OutputFile, ReplacesNoFileThatOthersWroteOrThatIsOfAnotherKind) {
  const std::pair<const char*, const char*> files[] = {
      {"scenario", "world = \"room\"\n[[uav]]\n"},
      {"campaign", "scenario = [\"a\"]\n"},
      {"broken.toml", "world = [\n"},
      {"room", "<sdf version=\"1.9\"/>"},
      {"record", "\x89MCAP0\r\n"},
      {"result.json", "{}"},
      {"campaign.json", "{}"},
      {"record.mcap", "damaged"},
      {"size.json", "{}"},
  };
  for (const auto& [name, text] : files)
    for (const OutputFormat format : kAll)
      EXPECT_THAT(refusal_of(scratch_.write(name, text), format),
                  testing::HasSubstr(scratch_.path(name).string() + " exists and is no "));
  for (const OutputFormat format :
       {OutputFormat::kJunit, OutputFormat::kHtml, OutputFormat::kTiming})
    refusal_of(scratch_.write("notes.txt", "my notes"), format);
}

TEST_F(OutputFile, ReplacesFilesOfItsOwnFormat) {
  const std::tuple<const char*, const char*, OutputFormat> files[] = {
      {"j.xml", "<?xml version=\"1.0\"?>\n<testsuites>\n", OutputFormat::kJunit},
      {"p.html", "<!DOCTYPE html>\n<html>", OutputFormat::kHtml},
      {"t.csv", "stage,mean\n", OutputFormat::kCsv},
      {"r.md", "| a | b |\n", OutputFormat::kText},
      {"b.timing", "tether-timing 1\n", OutputFormat::kTiming},
  };
  for (const auto& [name, text, format] : files)
    EXPECT_NO_THROW(require_output_file("--csv", scratch_.write(name, text), format)) << name;
}

TEST_F(OutputFile, MayBeMissingEmptyOrADeviceButNoFolder) {
  for (const OutputFormat format : kAll) {
    for (const fs::path& file : {fs::path(), scratch_.path("none"), fs::path("/dev/null"),
                                 fs::path(scratch_.write("result.json", ""))})
      EXPECT_NO_THROW(require_output_file("--csv", file, format)) << file;
    EXPECT_THAT(refusal_of(scratch_.path(), format), testing::HasSubstr("is a folder"));
  }
}

}  // namespace
}  // namespace tether::app
