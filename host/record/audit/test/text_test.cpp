#include <gtest/gtest.h>

#include <tether/audit/audit.h>

namespace tether::audit {
namespace {

TEST(ToText, WithoutFindingsIsOneLineAndTheGridError) {
  Verdict verdict;
  verdict.reached = from_ns<SimTime>(500'000'000);
  EXPECT_EQ(to_text(verdict),
            "INCOMPLETE, truncated at ST 0.500000 s, no finding before: 0 interactions, not "
            "synchronised: rules 1 to 7 do not apply\n");
  verdict.synchronised = verdict.complete = true;
  verdict.interactions = 42;
  verdict.largest_grid_error = Duration(999'999);
  EXPECT_EQ(to_text(verdict),
            "passed: 42 interactions follow the rules of time\n  largest grid error 0.999999 ms\n");
  EXPECT_EQ(to_line(verdict), "passed: 42 interactions follow the rules of time");
}

TEST(ToText, ListsFindingsUpToTheLimit) {
  Verdict verdict;
  verdict.notes = {"a note"};
  verdict.complete = true;
  verdict.further_findings = 2;
  verdict.findings = {{3, "a", 7, from_ns<SimTime>(1'500'000'000), "too late"},
                      {0, "", 0, {}, "wrong"},
                      {0, "", 0, {}, "not shown"}};
  EXPECT_EQ(to_text(verdict, 2),
            "FAILED: 5 findings in 0 interactions\n"
            "  note: a note\n"
            "  rule 3 (ST 1.500000 s, a #7): too late\n"
            "  record (ST 0.000000 s): wrong\n"
            "  … and 3 more\n");
  EXPECT_EQ(to_line(verdict),
            "FAILED: 5 findings in 0 interactions: rule 3 (ST 1.500000 s, a #7): too late");
}

}  // namespace
}  // namespace tether::audit
