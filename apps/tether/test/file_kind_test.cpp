#include "reading/file_kind.h"

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

namespace fs = std::filesystem;

TEST(FileKind, OfEveryShippedFileIsRecognised) {
  const fs::path data = fs::path(TETHER_SOURCE_DIR) / "data";
  const std::pair<const char*, FileKind> folders[] = {
      {"scenarios", FileKind::kScenario}, {"campaigns", FileKind::kCampaign},
      {"profiles", FileKind::kProfile},   {"profiles/targets", FileKind::kTarget},
      {"missions", FileKind::kMission},   {"rigs", FileKind::kRig},
      {"worlds", FileKind::kWorld},       {"models/hummingbird", FileKind::kWorld},
  };
  for (const auto& [folder, kind] : folders) {
    for (const auto& entry : fs::directory_iterator(data / folder)) {
      if (!entry.is_regular_file()) continue;
      EXPECT_EQ(kind_of(entry.path()), kind) << entry.path();
      EXPECT_NO_THROW(require_kind(entry.path(), kind));
      const FileKind other =
          kind == FileKind::kScenario ? FileKind::kCampaign : FileKind::kScenario;
      const Error error =
          thrown_error(ErrorCode::kUsage, [&] { require_kind(entry.path(), other); });
      EXPECT_EQ(error.subject(), entry.path());
    }
  }
}

TEST(FileKind, OfFoldersAndRecordsIsRecognisedAndOthersMayBeAnything) {
  const ScratchFolder scratch;
  scratch.write("run/result.json", "{}");
  scratch.write("killed/record.mcap", "\x89MCAP0\r\n");
  scratch.write("campaign/campaign.json", "{}");
  EXPECT_EQ(kind_of(scratch.path("run")), FileKind::kRun);
  EXPECT_EQ(kind_of(scratch.path("killed")), FileKind::kRun);
  EXPECT_EQ(kind_of(scratch.path("killed/record.mcap")), FileKind::kRecord);
  EXPECT_EQ(kind_of(scratch.path("campaign")), FileKind::kCampaignFolder);
  for (const auto& [name, text] : {std::pair{"fly.py", "import cv2\n"}, {"fly", "#!/bin/sh\n"}}) {
    const std::string program = scratch.write(name, text);
    EXPECT_EQ(kind_of(program), FileKind::kProgram);
    const Error error =
        thrown_error(ErrorCode::kUsage, [&] { require_kind(program, FileKind::kScenario); });
    EXPECT_NE(std::string(error.what()).find("tether run -- " + program), std::string::npos);
  }
  for (const fs::path& other :
       {scratch.path(), scratch.path("none"), fs::path("/dev/zero"),
        fs::path(scratch.write("a", "")), fs::path(scratch.write("b.toml", "name = [")),
        fs::path(scratch.write("c.toml", "name = \"x\""))}) {
    EXPECT_EQ(kind_of(other), std::nullopt) << other;
    EXPECT_NO_THROW(require_kind(other, FileKind::kScenario));
  }
}

}  // namespace
}  // namespace tether::app
