#include "faults.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>

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

bool wait_until(const std::function<bool()>& holds, std::chrono::duration<double> limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!holds()) {
    if (std::chrono::steady_clock::now() >= deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

nlohmann::json expect_failed(const Output& output, const std::filesystem::path& out,
                             const Failure& failure, const std::string& mark) {
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_FALSE(output.timed_out);
  EXPECT_TRUE(wait_until_gone(mark));
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

bool HeldResult::is_waited_for() const try {
  const record::Record record = read_record(out_);
  return record.footer && record.damage.empty();
} catch (const Error&) {
  return false;  // not there yet, or not its header
}

void HeldResult::tear() const {
  const auto torn = out_ / "torn";
  write_text(torn, "{\n  \"schema\": 1,\n  \"outc");
  std::filesystem::rename(torn, part_);
}

void expect_not_in_ci() {
  EXPECT_EQ(std::getenv("CI"), nullptr) << "what CI skips nobody tests";
}

Command limited(const Command& command, const std::string& limits) {
  Command shell = command;
  const std::string close_inherited = "exec 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&-; ";
  shell.arguments = {"sh", "-c", close_inherited + "ulimit " + limits + "; exec \"$@\"", "sh"};
  shell.arguments.insert(shell.arguments.end(), command.arguments.begin(), command.arguments.end());
  return shell;
}

}  // namespace tether::system_test
