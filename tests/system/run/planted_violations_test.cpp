#include "support/trials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether audit` on the record of a real run, altered. A violation of each rule:
/// host/record/audit/test/planted_test.cpp.
namespace tether::system_test {
namespace {

using testing::HasSubstr;

TEST(Audit, FindsWhatWasAlteredInTheRecordOfARun) {
  const TempFolder folder;
  ASSERT_EQ(
      run(tether({"run", write_hover_scenario(folder.path(), "good"), "--out", folder / "out"}))
          .code,
      0);
  const record::Record sound = read_record(folder / "out");
  const auto audit = [&](const record::Record& record) {
    write_record(folder / "record.mcap", record);
    return run(tether({"audit", folder / "record.mcap"}));
  };
  EXPECT_EQ(audit(sound).code, 0);

  record::Record with_a_gap = sound;
  with_a_gap.interactions.erase(with_a_gap.interactions.begin() + 50);
  const Output planted = audit(with_a_gap);
  EXPECT_EQ(planted.code, 1);
  EXPECT_THAT(planted.out, HasSubstr("rule 5"));

  record::Record cut = sound;
  cut.footer.reset();
  EXPECT_EQ(audit(cut).code, 1);
}

}  // namespace
}  // namespace tether::system_test
