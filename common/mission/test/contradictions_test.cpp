#include "contradictions.h"

#include "mission_text.h"

#include <gtest/gtest.h>

namespace tether::mission {
namespace {

/// Two clauses on the same quantity; the second is in line 13.
std::string two(const std::string& first, const std::string& second) {
  return kTasks + "[[clause]]\n" + first + "\n[[clause]]\nname = \"second\"\n" + second + "\n";
}

TEST(Contradictions, AreRefused) {
  for (const auto& [first, second] : std::vector<std::pair<std::string, std::string>>{
           {R"(always = "altitude <= 1 m")", R"(always = "altitude >= 120 cm")"},
           {R"(always = "altitude <= 1 m")", R"(eventually = "altitude >= 2 m")"},
           {R"(never = "altitude >= 1 m")", R"(eventually = "altitude >= 2 m")"},
           {R"(never = "altitude >= 1 m")", R"(eventually = "altitude >= 1 m")"},
           {R"(never = "altitude <= 9 cm")", R"(always = "altitude <= 9 cm")"},
           {"after = \"find\"\nalways = \"altitude <= 1 m\"",
            "after = \"find\"\nnever = \"altitude <= 1.5 m\""},
           {"during = [\"find\", \"fly\"]\nalways = \"distance <= 1 m\"",
            "during = [\"fly\"]\neventually = \"distance of blue_box >= 2 m\""}}) {
    const std::string text = two(first, second);
    const auto lines = std::count(first.begin(), first.end(), '\n');
    expect_refusal(text, 13 + static_cast<int>(lines), "second");
  }
}

TEST(Contradictions, AreNotBetweenClausesThatCanBothBeMet) {
  for (const auto& [first, second] : std::vector<std::pair<std::string, std::string>>{
           {R"(always = "altitude <= 1 m")", R"(always = "altitude >= 100 cm")"},
           {R"(eventually = "altitude <= 1 m")", R"(eventually = "altitude >= 2 m")"},
           {R"(always = "altitude <= 1 m in 50 %")", R"(eventually = "altitude >= 2 m")"},
           {R"(always = "distance of a <= 1 m")", R"(always = "distance of b >= 2 m")"},
           {R"(always = "altitude <= 1 m")", R"(always = "distance >= 2 m")"},
           {R"(always = "altitude <= 1 m")", "within_s = 3"},
           {"during = [\"find\"]\nalways = \"altitude <= 1 m\"",
            "during = [\"find\", \"fly\"]\neventually = \"altitude >= 2 m\""}})
    EXPECT_NO_THROW(parsed(two(first, second))) << first << second;
}

}  // namespace
}  // namespace tether::mission
