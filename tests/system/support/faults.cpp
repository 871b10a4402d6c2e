#include "faults.h"

#include <cstdlib>
#include <stdexcept>

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tether::system_test {

using testing::HasSubstr;
using testing::Not;

namespace {
constexpr const char* kResultPart = "result.json.part";
}

std::string mark_of_test() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::string(test->test_suite_name()) + test->name() + std::to_string(getpid());
}

bool sut_prints(const std::filesystem::path& out, const std::string& text) {
  return wait_until(
      [&] { return read_text(out / "sut-uav1.log").find(text) != std::string::npos; });
}

void wait_until_recorded(Process& tether, const std::filesystem::path& out,
                         std::size_t interactions) {
  const bool recorded = wait_until([&] {
    const auto record = record_so_far(out);
    return tether.has_ended() || (record && record->interactions.size() >= interactions);
  });
  if (!recorded || tether.has_ended()) throw std::runtime_error("no flight: " + tether.err());
}

Command RunTest::flight(const std::string& mode, const std::vector<std::string>& options,
                        const std::vector<Substitution>& changes) const {
  const auto scenario = write_hover_scenario(folder_.path(), mode, changes);
  return with(tether({"run", scenario, "--force", "--out", out_}, mark_), options);
}

nlohmann::json RunTest::expect_failed(const Output& output, const Failure& failure,
                                      const std::filesystem::path& out) const {
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_FALSE(output.timed_out);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(out / kResultPart));
  const auto result = read_result(out);
  const std::string reason = result["reason"];
  EXPECT_EQ(result["outcome"], "failed");
  EXPECT_EQ(result["exit_code"], 3);
  EXPECT_EQ(result["end"], failure.end) << reason;
  for (const auto& [name, metric] : result.at("metrics").items())
    EXPECT_TRUE(metric.at("value").is_null()) << name << ": " << metric;
  for (const std::string& part : failure.reason) EXPECT_THAT(reason, HasSubstr(part));
  EXPECT_THAT(reason, Not(HasSubstr("\n")));
  EXPECT_THAT(output.err, HasSubstr("tether: " + reason));
  return result;
}

HeldResult::HeldResult(const std::filesystem::path& out) : out_(out), part_(out / kResultPart) {
  std::filesystem::create_directories(out);
  // Opening it for writing waits for a reader, who never comes.
  if (mkfifo(part_.c_str(), 0600) != 0) throw std::runtime_error(part_.string());
}

bool HeldResult::is_reached() const {
  return wait_until([&] {
    const auto record = record_so_far(out_);
    return record && record->footer && record->damage.empty();
  });
}

void HeldResult::tear() const {
  const auto truncated = out_ / "truncated";
  write_text(truncated, "{\n  \"schema\": 1,\n  \"outc");
  std::filesystem::rename(truncated, part_);
}

void expect_not_in_ci() {
  EXPECT_EQ(std::getenv("CI"), nullptr) << "what CI skips nobody tests";
}

Command limited(const Command& command, const std::string& limits) {
  const std::string close_inherited = "exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ";
  return started_by({"sh", "-c", close_inherited + "ulimit " + limits + "; exec \"$@\"", "sh"},
                    command);
}

}  // namespace tether::system_test
