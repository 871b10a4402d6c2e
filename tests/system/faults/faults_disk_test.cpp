#include "support/faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

/// Nowhere to write, or no longer; and records that are torn (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::ContainsRegex;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class Folder : public testing::Test {
 protected:
  Command flight(const std::filesystem::path& out, const std::string& mode = "good") {
    return tether({"run", write_hover_scenario(folder_.path(), mode), "--out", out}, mark_);
  }
  /// Ended by the set-up's exit code with one line that holds these, and nothing left running.
  void expect_no_result(const Output& output, const std::vector<std::string>& parts) {
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, HasSubstr("tether: "));
    for (const std::string& part : parts) EXPECT_THAT(output.err, HasSubstr(part));
    EXPECT_TRUE(wait_until_gone(mark_));
  }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
};

// ---- Full

TEST_F(Folder, WhoseFilesMayNotGrowEndsTheRunWithItsReason) {
  const auto out = folder_ / "out";
  const Output output = run(limited(flight(out), "-f 32"));
  expect_failed(output, out, {"setup_failed", {(out / "record.mcap").string(), "File too large"}},
                mark_);
  EXPECT_FALSE(std::filesystem::exists(out / "record.mcap"));

  EXPECT_EQ(run(flight(out)).code, 0);
  EXPECT_EQ(read_result(out)["end"], "finished");
}

/// The command with its standard streams as a shell sets them.
Command with_streams(const Command& command, const std::string& redirection) {
  Command shell = command;
  shell.arguments = {"sh", "-c", "exec \"$@\" " + redirection, "sh"};
  shell.arguments.insert(shell.arguments.end(), command.arguments.begin(), command.arguments.end());
  return shell;
}

TEST_F(Folder, OfAnOutputThatIsNotAllThereIsNamed) {
  const auto out = folder_ / "out";
  ASSERT_EQ(run(flight(out)).code, 0);
  for (const Command& command :
       {flight(folder_ / "again"), tether({"audit", out / "record.mcap"}), tether({"report", out}),
        tether({"report", out, "--format", "csv"})}) {
    const Output output = run(with_streams(command, "> /dev/full"));
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, EndsWith(": No space left on device\n"));
  }
  EXPECT_EQ(read_result(folder_ / "again")["end"], "finished");
  const Output sut = run(with_streams({{sut_program().string(), "--help"}, {}, {}}, "> /dev/full"));
  EXPECT_EQ(sut.code, 3);
  EXPECT_THAT(sut.err, StartsWith("tether-sut: "));
}

TEST_F(Folder, OfMessagesThatCannotBeWrittenEndsNothing) {
  EXPECT_EQ(run(with_streams(tether({"run", folder_ / "none.toml"}), "2> /dev/full")).code, 2);
  write_hover_scenario(folder_.path(), "good");
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrials = 1\n\n[[scenario]]\nfile = \"hover.toml\"\n"
             "conditions = [\"host\"]\n");
  const Command campaign =
      tether({"campaign", folder_ / "campaign.toml", "--out", folder_ / "out"}, mark_);
  EXPECT_EQ(run(with_streams(campaign, "2> /dev/full")).code, 0);
}

// Files that are opened would get their numbers, and what is said of a silent SUT would get there.
TEST_F(Folder, IsNotPrintedIntoByWhoHasNoStreams) {
  const auto out = folder_ / "out";
  EXPECT_EQ(run(with_streams(flight(out, "stop"), "<&- >&- 2>&-")).code, 3);
  EXPECT_EQ(read_result(out)["end"], "sut_hung");
  EXPECT_EQ(run(tether({"audit", out / "record.mcap"})).err, "");
}

TEST_F(Folder, OfAnOutputThatGoesNowhereIsNamed) {
  const auto out = folder_ / "out";
  for (const Command& command : {flight(out), tether({"report", out})}) {
    const Output output = run(with_streams(command, ">&-"));
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, EndsWith(": Bad file descriptor\n"));
  }
  EXPECT_EQ(read_result(out)["end"], "finished");
  EXPECT_EQ(run(with_streams(tether({"report", out}), "<&- 2>&-")).code, 0);
}

/// The command with a file system of that many KiB, all of it full but for `free`, at `folder`,
/// which is its alone. `then` is run where it can be seen.
Command on_small_disk(const Command& command, const std::filesystem::path& folder, int size_kib,
                      const std::string& then) {
  Command shell = command;
  const std::string user = geteuid() == 0 ? "-m" : "-rm";
  shell.arguments = {"unshare",
                     user,
                     "sh",
                     "-c",
                     "mount -t tmpfs -o size=" + std::to_string(size_kib) + "k none '" +
                         folder.string() + "' && { \"$@\"; code=$?; " + then + "; exit $code; }",
                     "sh"};
  shell.arguments.insert(shell.arguments.end(), command.arguments.begin(), command.arguments.end());
  return shell;
}

class Disk : public Folder {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(disk_);
    const Command nothing{.arguments = {"true"}, .environment = {}, .working_folder = {}};
    if (run(on_small_disk(nothing, disk_, 64, "true")).code != 0) {
      expect_not_in_ci();
      GTEST_SKIP() << "no file systems may be mounted here";
    }
  }
  const std::filesystem::path disk_ = folder_ / "disk";
  const std::filesystem::path kept_ = folder_ / "kept";
};

TEST_F(Disk, ThatGetsFullEndsTheRunWithItsReason) {
  const Output output =
      run(on_small_disk(flight(disk_ / "out"), disk_, 48,
                        "cp -r '" + (disk_ / "out").string() + "' '" + kept_.string() + "'"));
  expect_failed(output, kept_,
                {"setup_failed", {(disk_ / "out/record.mcap").string(), "No space left on device"}},
                mark_);
  EXPECT_FALSE(std::filesystem::exists(kept_ / "record.mcap"));
}

// A campaign's finished trials stay, those that found no room are told, and it may go on.
TEST_F(Disk, ThatGetsFullInACampaignKeepsWhatIsFinished) {
  write_hover_scenario(folder_.path(), "good");
  write_text(folder_ / "campaign.toml",
             "name = \"small\"\ntrials = 3\n\n[[scenario]]\nfile = \"hover.toml\"\n"
             "conditions = [\"host\"]\n");
  const Output output =
      run(on_small_disk(
              tether({"campaign", folder_ / "campaign.toml", "--out", disk_ / "out"}, mark_), disk_,
              150, "cp -r '" + (disk_ / "out").string() + "' '" + kept_.string() + "'"),
          100s);
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_TRUE(wait_until_gone(mark_));
  const auto first = kept_ / "hover/host/seed-0001";
  EXPECT_EQ(read_result(first)["end"], "finished");
  EXPECT_EQ(run(tether({"audit", first / "record.mcap"})).code, 0);
  for (const char* trial : {"hover/host/seed-0002", "hover/host/seed-0003"}) {
    if (!std::filesystem::exists(kept_ / trial / "result.json")) continue;
    const auto result = read_result(kept_ / trial);
    if (result["end"] == "finished") continue;
    EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("No space left on device"));
  }
  const std::string kept = read_text(first / "result.json");
  const Output resumed =
      run(tether({"campaign", folder_ / "campaign.toml", "--out", kept_, "--resume"}, mark_), 100s);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(read_text(first / "result.json"), kept);
}

// ---- Not writable

/// The command as a user who owns nothing.
Command as_nobody(const Command& command) {
  if (geteuid() != 0) return command;
  Command other = command;
  other.arguments = {"setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"};
  other.arguments.insert(other.arguments.end(), command.arguments.begin(), command.arguments.end());
  return other;
}

bool others_may_run() {
  const bool they_may = run(as_nobody(tether({"--version"}))).code == 0;
  if (!they_may) expect_not_in_ci();
  return they_may;
}

TEST_F(Folder, ThatMayNotBeWrittenIsNamedBeforeAnythingStarts) {
  namespace fs = std::filesystem;
  if (!others_may_run()) GTEST_SKIP() << "nobody else may run this build";
  fs::permissions(folder_.path(), fs::perms::owner_all | fs::perms(0055));
  const auto locked = folder_ / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms(0555));
  for (const auto& out : {locked, locked / "below"}) {
    const Output output = run(as_nobody(flight(out)));
    expect_no_result(output, {out.string() + ": Permission denied", "--out"});
  }
  EXPECT_TRUE(fs::is_empty(locked));
}

TEST_F(Folder, ThatMayNoLongerBeWrittenEndsTheRunAndItsEndIsTold) {
  namespace fs = std::filesystem;
  if (!others_may_run()) GTEST_SKIP() << "nobody else may run this build";
  fs::permissions(folder_.path(), fs::perms::all);
  const auto out = folder_ / "out";
  Process process(as_nobody(flight(out, "pause")));
  ASSERT_TRUE(wait_until([&] {
    return read_text(out / "sut-uav1.log").find("pausing") != std::string::npos;
  })) << process.err();
  fs::permissions(out, fs::perms(0555));
  expect_no_result(process.wait(30s), {(out / "result.json").string(), "Permission denied"});
  EXPECT_FALSE(fs::exists(out / "result.json"));
  // It was open.
  EXPECT_EQ(read_record(out).footer->end, "finished");
}

TEST_F(Folder, ThatIsAFileIsNamed) {
  const auto file = folder_ / "out";
  write_text(file, "mine");
  expect_no_result(run(flight(file)), {file.string() + ": ", "--out"});
  expect_no_result(run(flight(file / "below")), {file.string(), "--out"});
  EXPECT_EQ(read_text(file), "mine");
}

TEST_F(Folder, ThatIsRemovedInFlightEndsTheRunAndItsEndIsTold) {
  const auto out = folder_ / "out";
  Process process(flight(out, "pause"));
  ASSERT_TRUE(wait_until([&] {
    return read_text(out / "sut-uav1.log").find("pausing") != std::string::npos;
  })) << process.err();
  std::filesystem::remove_all(out);
  expect_no_result(process.wait(30s), {(out / "result.json").string(), "No such file"});
  EXPECT_FALSE(std::filesystem::exists(out));
}

// ---- Torn records

class TornRecord : public Folder {
 protected:
  void SetUp() override {
    ASSERT_EQ(run(flight(out_)).code, 0);
    whole_ = read_text(file_);
  }
  void tear_to(std::size_t size) const { write_text(file_, whole_.substr(0, size)); }

  const std::filesystem::path out_ = folder_ / "out", file_ = out_ / "record.mcap";
  std::string whole_;
};

// The reader alone: every byte of a small record, in host/record/test/damage_test.cpp.
TEST_F(TornRecord, IsAuditedUpToTheTearWhichIsNamed) {
  for (const std::size_t part : {30u, 60u, 90u, 99u}) {
    tear_to(whole_.size() * part / 100);
    const Output audit = run(tether({"audit", file_}));
    EXPECT_EQ(audit.code, 1);
    EXPECT_THAT(audit.err, ContainsRegex(file_.string() + ": .* [0-9]+"));  // which byte
  }
  tear_to(whole_.size() - 1);
  EXPECT_EQ(run(tether({"audit", file_})).code, 1);
}

TEST_F(TornRecord, WithoutItsBeginningIsABadFile) {
  for (const std::size_t size : {0u, 10u, 200u}) {
    tear_to(size);
    const Output audit = run(tether({"audit", file_}));
    EXPECT_EQ(audit.code, 2) << size;
    EXPECT_THAT(audit.err, StartsWith("tether: " + file_.string() + ": "));
    for (const char* command : {"plot", "frames"}) {
      const Output output = run(tether({command, file_}));
      EXPECT_EQ(output.code, 2) << command << ", " << size;
      EXPECT_EQ(output.err, audit.err);
    }
  }
}

TEST_F(TornRecord, ChangesNoTableOfTheRun) {
  const Output whole = run(tether({"report", out_}));
  for (const std::size_t size : {whole_.size() / 2, std::size_t{200}}) {
    tear_to(size);
    const Output torn = run(tether({"report", out_}));
    EXPECT_EQ(torn.code, 0);
    EXPECT_EQ(torn.out, whole.out);
  }
}

TEST_F(TornRecord, IsNamedOnTheRunsPage) {
  if (run({.arguments = {"gnuplot", "--version"}, .environment = {}, .working_folder = {}}).code !=
      0)
    GTEST_SKIP() << "no gnuplot";
  tear_to(whole_.size() * 6 / 10);
  EXPECT_EQ(run(tether({"report", out_, "--format", "html"})).code, 0);
  EXPECT_THAT(read_text(out_ / "report.html"), HasSubstr(file_.string()));
  tear_to(200);
  EXPECT_EQ(run(tether({"report", out_, "--format", "html"})).code, 0);
  EXPECT_THAT(read_text(out_ / "report.html"), HasSubstr(file_.string() + ": "));
}

TEST_F(TornRecord, OfImagesIsDrawnUpToTheTearWhichIsNamed) {
  const auto scenario = write_face_scenario(
      folder_.path(), {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 10"}});
  ASSERT_EQ(run(tether({"run", scenario, "--images", "--quiet", "--out", out_}, mark_)).code, 0);
  whole_ = read_text(file_);
  tear_to(whole_.size() / 2);
  const Output frames = run(tether({"frames", file_}));
  EXPECT_EQ(frames.code, 0);
  EXPECT_THAT(frames.err, ContainsRegex(file_.string() + ": .* [0-9]+"));
  tear_to(30'000);
  const Output none = run(tether({"frames", file_}));
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, ContainsRegex(file_.string() + ": .* [0-9]+"));
}

}  // namespace
}  // namespace tether::system_test
