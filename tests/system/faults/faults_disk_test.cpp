#include "support/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

/// Nowhere to write, or no longer; and truncated records (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class Folder : public RunTest {
 protected:
  /// Ended by the set-up's exit code with one line that names these, and nothing left running.
  void expect_no_result(const Output& output, const std::vector<std::string>& named) {
    EXPECT_EQ(output.code, 3);
    for (const std::string& part : named) EXPECT_THAT(output.err, HasSubstr(part));
    EXPECT_TRUE(wait_until_gone(mark_));
  }
  /// The record is there as far as it went, and `tether audit` gives its extent. The result has the
  /// extent of the run.
  void expect_truncated(const nlohmann::json& result, const std::filesystem::path& out) {
    const record::Record record = read_record(out);
    EXPECT_FALSE(record.footer);
    EXPECT_GT(record.interactions.size(), 0u);
    EXPECT_GE(result["sync"]["interactions"], record.interactions.size());
    EXPECT_GE(result["sync"]["st_at_end_s"], to_seconds(record::last_time(record)));
    const Output audit = run(tether({"audit", out / "record.mcap"}));
    EXPECT_EQ(audit.code, 1);
    EXPECT_THAT(audit.out, HasSubstr("truncated at ST"));
    EXPECT_THAT(result["audit"]["summary"].get<std::string>(), HasSubstr("truncated at ST"));
  }
};

// ---- Full

TEST_F(Folder, WhoseFilesMayNotGrowEndsTheRunWithItsReason) {
  const auto failure = expect_failed(
      run(limited(flight(), "-f 96")),
      {"setup_failed", {(out_ / "record.mcap").string(), "File too large", "the run reached ST"}});
  expect_truncated(failure, out_);
  EXPECT_EQ(run(flight()).code, 0);
  EXPECT_EQ(result()["end"], "finished");
}

/// The command with its standard streams as a shell sets them.
Command with_streams(const Command& command, const std::string& redirection) {
  return started_by({"sh", "-c", "exec \"$@\" " + redirection, "sh"}, command);
}

TEST_F(Folder, OfAnOutputThatCannotBeWrittenHasItsFilesAllTheSame) {
  for (const auto& [stream, why] :
       {std::pair{"> /dev/full", "No space left on device"}, {">&-", "Bad file descriptor"}}) {
    for (const Command& command :
         {flight(), tether({"audit", out_ / "record.mcap"}), tether({"report", out_})}) {
      const Output output = run(with_streams(command, stream));
      EXPECT_EQ(output.code, 3);
      EXPECT_THAT(output.err, EndsWith(std::string(why) + "\n"));
    }
    EXPECT_EQ(result()["end"], "finished");
  }
  EXPECT_EQ(run(with_streams({{sut_program(), "--help"}}, "> /dev/full")).code, 3);
}

TEST_F(Folder, OfMessagesThatCannotBeWrittenEndsNothing) {
  EXPECT_EQ(run(with_streams(tether({"run", folder_ / "none.toml"}), "2> /dev/full")).code, 2);
  write_hover_scenario(folder_.path(), "good");
  const Command campaign = tether({"campaign", write_campaign(folder_.path(), 1), "--out", out_});
  EXPECT_EQ(run(with_streams(campaign, "2> /dev/full")).code, 0);
}

// Files that are opened would get their numbers, and messages about a silent SUT would get there.
TEST_F(Folder, IsNotPrintedIntoByARunWithoutStreams) {
  EXPECT_EQ(run(with_streams(flight("stop"), "<&- >&- 2>&-")).code, 3);
  EXPECT_EQ(result()["end"], "sut_hung");
  EXPECT_EQ(run(tether({"audit", out_ / "record.mcap"})).err, "");
}

/// The command with a full file system of that many KiB at `disk`, which it alone sees, and whose
/// folder "out" is copied to `kept` at the end.
Command on_small_disk(const Command& command, const std::filesystem::path& disk, int size_kib,
                      const std::filesystem::path& kept) {
  const std::string mount =
      "mount -t tmpfs -o size=" + std::to_string(size_kib) + "k none '" + disk.string() + "'";
  const std::string copy = "cp -r '" + (disk / "out").string() + "' '" + kept.string() + "'";
  return started_by({"unshare", geteuid() == 0 ? "-m" : "-rm", "sh", "-c",
                     mount + " && { \"$@\"; code=$?; " + copy + "; exit $code; }", "sh"},
                    command);
}

class Disk : public Folder {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(disk_);
    if (run(on_small_disk({{"true"}}, disk_, 64, kept_)).code != 0) {
      expect_not_in_ci();
      GTEST_SKIP() << "no file systems may be mounted here";
    }
  }
  const std::filesystem::path disk_ = folder_ / "disk";
  const std::filesystem::path kept_ = folder_ / "kept";
};

TEST_F(Disk, ThatGetsFullEndsTheRunWithItsReason) {
  const Command command =
      tether({"run", write_hover_scenario(folder_.path(), "good"), "--out", disk_ / "out"}, mark_);
  const std::string record = disk_ / "out/record.mcap";
  expect_truncated(expect_failed(run(on_small_disk(command, disk_, 80, kept_)),
                                 {"setup_failed", {record, "No space left on device"}}, kept_),
                   kept_);
}

// Where all processes of a program have their time.
TEST_F(Disk, ForTemporaryFilesThatIsFullIsTheReason) {
  const Command fly =
      tether({"run", "--quiet", "--out", folder_ / "kept", "--", "/bin/true"}, mark_);
  const Output output = run(on_small_disk(started_by({"env", "TMPDIR=" + disk_.string()}, fly),
                                          disk_, 64, folder_ / "none"));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("/page: No space left on device"));
}

// A campaign's finished trials stay, those that found no room are reported, and it may go on.
TEST_F(Disk, ThatGetsFullInACampaignKeepsWhatIsFinished) {
  write_hover_scenario(folder_.path(), "good");
  const auto campaign = write_campaign(folder_.path(), 3, "conditions = [\"host\"]\n");
  const Output output = run(on_small_disk(
      tether({"campaign", campaign, "--out", disk_ / "out"}, mark_), disk_, 150, kept_));
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_TRUE(wait_until_gone(mark_));
  const auto first = kept_ / "hover/host/seed-0001";
  EXPECT_EQ(read_result(first)["end"], "finished");
  EXPECT_EQ(audit_code(first), 0);
  for (const char* trial : {"hover/host/seed-0002", "hover/host/seed-0003"}) {
    if (!std::filesystem::exists(kept_ / trial / "result.json")) continue;
    const auto result = read_result(kept_ / trial);
    if (result["end"] == "finished") continue;
    EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("No space left on device"));
  }
  const std::string kept = read_text(first / "result.json");
  const Output resumed = run(tether({"campaign", campaign, "--out", kept_, "--resume"}, mark_));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(read_text(first / "result.json"), kept);
}

// ---- Not writable

// Further cases: host/trial/runner/test/trial_folder_test.cpp.
TEST_F(Folder, ThatIsAFileIsNamed) {
  write_text(out_, "mine");
  const Output output = run(flight());
  EXPECT_EQ(output.code, 2);
  EXPECT_THAT(output.err, HasSubstr(out_.string() + ": is a file, not a folder"));
  EXPECT_EQ(read_text(out_), "mine");
}

TEST_F(Folder, ThatIsRemovedInFlightEndsTheRun) {
  Process process(flight("pause"));
  ASSERT_TRUE(sut_prints(out_, "pausing")) << process.err();
  std::filesystem::remove_all(out_);
  expect_no_result(process.wait(30s), {(out_ / "result.json").string(), "No such file"});
  EXPECT_FALSE(std::filesystem::exists(out_));
}

// ---- Truncated records. The reader alone: host/record/record/test/damage_test.cpp

using TruncatedRecord = RunTest;

TEST_F(TruncatedRecord, IsReadAsFarAsItIsWhole) {
  const auto scenario = write_face_scenario(
      folder_.path(), {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 10"}});
  ASSERT_EQ(run(tether({"run", scenario, "--images", "--quiet", "--out", out_})).code, 0);
  const std::string file = out_ / "record.mcap", whole = read_text(file);
  const std::string computing_time = "Where the computing time goes";
  const auto expect = [&](const char* command, int code) {
    const Output output = run(tether({command, file}));
    EXPECT_EQ(output.code, code) << command;
    EXPECT_THAT(output.err, HasSubstr(file + ": ")) << command;
  };
  for (const std::size_t size : {whole.size() - 1, whole.size() / 2}) {
    write_text(file, whole.substr(0, size));
    for (const char* drawings : {"frames", "plots"}) std::filesystem::remove_all(out_ / drawings);
    expect("audit", 1);
    expect("frames", 0);
  }
  EXPECT_THAT(run(tether({"report", out_})).out,
              AllOf(HasSubstr("seed 1: goal_reached"), HasSubstr(computing_time)))
      << "which needs no record";
  // Without its header it is a bad file.
  for (const std::size_t size : {0u, 200u}) {
    write_text(file, whole.substr(0, size));
    for (const char* command : {"audit", "plot", "frames"}) expect(command, 2);
  }
  EXPECT_THAT(run(tether({"report", out_})).out, HasSubstr("seed 1: goal_reached"));
}

}  // namespace
}  // namespace tether::system_test
