#include "records/output_folder.h"

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>

namespace tether::app {
namespace {

TEST(OutputFolder, RefusesDrawingsOfAnotherRecordOnly) {
  const ScratchFolder scratch;
  const auto record = scratch.path("record.mcap"), plots = scratch.path("plots");
  const auto make = [&](const std::set<std::string>& drawings) {
    return make_output_folder({}, record, "plots", drawings, "@(timeline*|lag*|path).svg");
  };
  EXPECT_EQ(make({"path.svg"}), plots);
  for (const char* file : {"plots/path.svg", "plots/lag-uav1.svg", "plots/mine.svg"})
    scratch.write(file, "");
  EXPECT_EQ(make({"path.svg", "lag-uav1.svg"}), plots);
  const Error error = thrown_error(ErrorCode::kUsage, [&] { make({"path.svg"}); });
  EXPECT_EQ(error.subject(), plots);
}

TEST(OutputFolder, RefusesAFile) {
  const ScratchFolder scratch;
  const auto file = scratch.write("notes.txt", "");
  const Error error = thrown_error(ErrorCode::kUsage, [&] {
    make_output_folder(file, scratch.path("record.mcap"), "plots", {}, "*");
  });
  EXPECT_EQ(error.subject(), file);
}

}  // namespace
}  // namespace tether::app
