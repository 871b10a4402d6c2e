#include "support/trials.h"

#include <algorithm>
#include <ostream>
#include <regex>

#include <gtest/gtest.h>

/// Flights of shipped scenarios by counted work: the same bytes under any load, and the rows of
/// README.md.
namespace tether::system_test {
namespace {

struct CountedCase {
  std::string scenario;
  std::vector<Substitution> changes{};
};

void PrintTo(const CountedCase& flight, std::ostream* stream) {
  *stream << flight.scenario;
}

class CountedFlight : public testing::TestWithParam<CountedCase> {
 protected:
  /// The run's folder.
  std::filesystem::path fly(const std::string& name, const std::vector<std::string>& launcher) {
    const auto out = folder_ / name;
    const auto command = tether({"run", file_, "--condition", "target", "--target",
                                 TETHER_SOURCE_DIR "/data/profiles/targets/counted_target.toml",
                                 "--quiet", "--out", out});
    const Output output = run(started_by(launcher, command), std::chrono::minutes(4));
    EXPECT_LE(output.code, 1) << output.err;
    EXPECT_TRUE(read_result(out)["audit"]["passed"]);
    return out;
  }

  TempFolder folder_;
  const std::filesystem::path file_ =
      write_shipped_scenario(folder_.path(), GetParam().scenario, GetParam().changes);
};

// On all cores, with images drawn ahead; then on one core beside others' load, from another
// environment and into another folder.
TEST_P(CountedFlight, IsTheSameToTheByteUnderAnyLoad) {
  const auto alone = fly("alone", {"env"});
  const Spinner first, second;
  const auto crowded = fly(std::string(100, 'x'), {"env", "-i", "PATH=/usr/bin:/bin",
                                                   "HOME=/nowhere", "taskset", "-c", "0"});
  EXPECT_GT(read_result(alone)["sync"]["interactions"], 5);
  EXPECT_TRUE(read_text(alone / "record.mcap") == read_text(crowded / "record.mcap"));
  EXPECT_EQ(timeless_result(alone), timeless_result(crowded));
}

// Cut short: the first images have all kinds of work.
const std::vector<CountedCase> kCountedCases = {
    {"face_anchor", {{"\ntime_limit_s = 60", "\ntime_limit_s = 0.7"}}},
    {"move_forward", {{"\ntime_limit_s = 90", "\ntime_limit_s = 0.7"}}},
    {"mission", {{"\ntime_limit_s = 60", "\ntime_limit_s = 0.7"}}}};

INSTANTIATE_TEST_SUITE_P(Shipped, CountedFlight, testing::ValuesIn(kCountedCases),
                         [](const auto& one) { return one.param.scenario; });

/// The numbers in the first line of `text` that begins with `label`.
std::vector<double> numbers_of(const std::string& text, const std::string& label) {
  std::smatch line;
  if (!std::regex_search(text, line, std::regex("(?:^|\n)" + label + "([^\n]*)"))) return {};
  const std::string rest = line[1];
  const std::regex number("[0-9]+(?:\\.[0-9]+)?");
  std::vector<double> numbers;
  for (std::sregex_iterator at(rest.begin(), rest.end(), number), end; at != end; ++at)
    numbers.push_back(std::stod(at->str()));
  return numbers;
}

// The program of scripts/demo has no assertions, and so slightly other counts.
TEST(Demo, FliesTheTableOfTheReadme) {
  constexpr double kMostByAssertions = 0.002;
  const TempFolder folder;
  write_text(folder / "demo.toml",
             substituted(read_text(TETHER_SOURCE_DIR "/data/campaigns/demo.toml"),
                         {{", \"target, no sync\"]", "]"}}));
  const Output flown =
      run(with(tether({"campaign", folder / "demo.toml", "--out", folder / "out", "--jobs", "2"}),
               {}, {{"COLUMNS", "200"}}),
          std::chrono::minutes(9));
  ASSERT_EQ(flown.code, 0) << flown.err;
  const std::size_t table = flown.out.find("Table III");
  ASSERT_NE(table, std::string::npos) << flown.out;
  const std::string readme = read_text(TETHER_SOURCE_DIR "/README.md");
  for (const std::string condition : {"host, counted", "target, counted"}) {
    // Mean and standard deviation of each metric, and the paper's.
    const auto shown = numbers_of(readme, "\\| " + condition);
    const auto own = numbers_of(flown.out.substr(table), condition);
    ASSERT_GE(shown.size(), 4u) << condition;
    ASSERT_GE(own.size(), 8u) << flown.out;
    const std::vector<double> flown_row = {own[0], own[1], own[4], own[5]};
    for (std::size_t i = 0; i < flown_row.size(); ++i)
      EXPECT_NEAR(shown[i], flown_row[i], kMostByAssertions) << condition << ", column " << i;
  }
}

}  // namespace
}  // namespace tether::system_test
