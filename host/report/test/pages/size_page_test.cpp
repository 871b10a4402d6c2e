#include "sample_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SizePage, BeginsWithTheAnswer) {
  const SizeReport report = sample_size();
  const std::string page = size_page(size_answer(report));
  const auto answer = page.find("<strong>Sufficient up to 3.1 × slower</strong> than");
  ASSERT_NE(answer, std::string::npos);
  EXPECT_LT(answer, page.find("<svg"));
  EXPECT_LT(page.find("<svg"), page.find("<table"));
  EXPECT_THAT(page, HasSubstr("<strong>Fast enough</strong>: pi.toml"));
  EXPECT_THAT(page, Not(HasSubstr("class=\"problems\"")));
}

TEST(SizePage, NamesFlightsThatFailed) {
  SizeReport report = sample_size();
  report.not_flown = {"seed 7: <crashed>"};
  EXPECT_THAT(size_page(size_answer(report)), HasSubstr("seed 7: &lt;crashed&gt;"));
}

}  // namespace
}  // namespace tether::report
