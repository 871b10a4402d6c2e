#include <cerrno>
#include <csignal>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/interrupt.h>
#include <tether/os/machine.h>
#include <tether/os/process_table.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

constexpr Duration kPatience = std::chrono::seconds(60);

class Child : public testing::Test {
 protected:
  ChildCommand shell(const std::string& script) const {
    return {.arguments = {"sh", "-c", script}, .environment = {}, .log = log_};
  }
  /// How it ended.
  ChildExit run(const ChildCommand& command) const {
    ChildProcess process(command);
    EXPECT_TRUE(process.wait(kPatience));
    return process.poll().value_or(ChildExit{});
  }
  std::string output_of(const ChildCommand& command) const {
    run(command);
    return read_whole(log_);
  }

  ScratchFolder scratch_;
  const std::filesystem::path log_ = scratch_.path("log");
};

TEST_F(Child, ReportsHowItEnded) {
  const struct {
    const char* script;
    int code;
    const char* description;
  } cases[] = {
      {"exit 0", 0, "exited with code 0"},
      {"exit 3", 3, "exited with code 3"},
      {"kill -SEGV $$", kSignalled + SIGSEGV, "was ended by signal 11 (Segmentation fault)"},
      {"exit 137", 137, "exited with code 137, as after signal 9 (Killed)"},
  };
  for (const auto& c : cases) {
    const ChildExit exit = run(shell(c.script));
    EXPECT_EQ(exit.code, c.code);
    EXPECT_EQ(exit.description, c.description);
  }
}

TEST_F(Child, CallsItsBodyInACopyOfThisProcessThatCanStartProgramsItself) {
  int changed = 1;
  const ChildExit exit = run({.arguments = {"a copy"}, .environment = {}, .log = log_, .body = [&] {
                                changed = 2;
                                std::cout << "out" << std::flush;
                                ChildProcess program(shell("exit 4"));
                                program.wait(kPatience);
                                return 3 + program.poll()->code;
                              }});
  EXPECT_EQ(exit.code, 7);
  EXPECT_EQ(changed, 1);
}

TEST_F(Child, HandlesSignalsOfACopyAsAProgramDoes) {
  const Interrupt interrupt;
  const auto in_a_copy = [&](std::function<int()> body) {
    return run({.arguments = {"a copy"}, .environment = {}, .log = log_, .body = std::move(body)});
  };
  EXPECT_EQ(in_a_copy([] { return raise(SIGTERM); }).code, kSignalled + SIGTERM);
  EXPECT_FALSE(interrupt.token().stop_requested());
  EXPECT_EQ(in_a_copy([&] { return in_a_copy([] { return 5; }).code; }).code, 5);
  EXPECT_EQ(in_a_copy([] {
              const Interrupt own;
              raise(SIGINT);
              while (!own.token().stop_requested()) std::this_thread::yield();
              return 6;
            }).code,
            6);
}

TEST_F(Child, AddsVariablesToTheEnvironmentOfThisProcess) {
  ChildCommand command = shell("echo $TETHER_TEST; echo ${PATH:+path}");
  command.environment = {{"TETHER_TEST", "two words"}};
  EXPECT_EQ(output_of(command), "two words\npath\n");
}

TEST_F(Child, WritesOneLogOrTwoAndAppendsOnlyWhenAsked) {
  ChildCommand command = shell("echo out; echo err >&2");
  output_of(command);
  EXPECT_EQ(output_of(command), "out\nerr\n");
  command.appends = true;
  command.errors = scratch_.path("errors");
  EXPECT_EQ(output_of(command), "out\nerr\nout\n");
  EXPECT_EQ(read_whole(command.errors), "err\n");
}

TEST_F(Child, ReadsAFileAPipeOrNothing) {
  ChildCommand command = shell("cat");
  EXPECT_EQ(output_of(command), "");
  Pipe pipe = make_pipe();
  ASSERT_TRUE(write_all(pipe.write_end, "of the pipe"));
  pipe.write_end = FileDescriptor();
  command.input_pipe = pipe.read_end.get();
  EXPECT_EQ(output_of(command), "of the pipe");
  command.input = scratch_.write("input", "of the file");
  EXPECT_EQ(output_of(command), "of the file");
}

TEST_F(Child, RunsInItsFolderOnItsCpusWithoutBlockedSignals) {
  const int cpu = allowed_cpus().back();
  ChildCommand command =
      shell("pwd -P; sed -n 's/^SigBlk:.//p; s/^Cpus_allowed_list:.//p' /proc/self/status");
  command.working_folder = scratch_.path();
  command.cpus = {cpu};
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const std::string output = output_of(command);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_EQ(output, std::filesystem::canonical(scratch_.path()).string() + "\n0000000000000000\n" +
                        std::to_string(cpu) + "\n");
}

TEST_F(Child, EndsWithItsObject) {
  pid_t pid = 0;
  {
    const ChildProcess process(shell("exec sleep 60"));
    pid = process.pid();
    EXPECT_EQ(kill(pid, 0), 0);
  }
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST_F(Child, GetsItsEndSignalAndIsKilledAfterItsGrace) {
  const auto terminated = [this](const char* trap, int end_signal, Duration grace) {
    ChildCommand command = shell(std::string(trap) + "; echo ready; while :; do :; done");
    command.end_signal = end_signal;
    command.grace = grace;
    ChildProcess process(command);
    while (read_whole(log_).empty()) process.wait(Duration(0));
    process.terminate();
    return process.poll()->code;
  };
  EXPECT_EQ(terminated("trap 'exit 7' INT", SIGINT, kPatience), 7);
  EXPECT_EQ(terminated("trap '' TERM", SIGTERM, std::chrono::milliseconds(1)),
            kSignalled + SIGKILL);
}

// However early they lose their own parent.
TEST_F(Child, AdoptsItsOrphansIfAsked) {
  for (const bool adopts : {false, true}) {
    const auto number = scratch_.path(adopts ? "adopted" : "not_adopted");
    ChildCommand command =
        shell("(setsid sh -c 'until [ -e " + number.string() + ".go ] || [ ! -d " +
              scratch_.path().string() + " ]; do :; done' & echo $! >" + number.string() +
              "); touch " + number.string() + ".ready; exec sleep 600");
    command.adopts_orphans = adopts;
    const ChildProcess child(command);
    while (!std::filesystem::exists(number.string() + ".ready")) std::this_thread::yield();
    const pid_t orphan = std::stoi(read_whole(number));
    EXPECT_EQ(process_stat(orphan)->parent == child.pid(), adopts);
    std::ofstream(number.string() + ".go").put('x');
  }
}

TEST_F(Child, EndsOrphansButNoProcessThatItStarted) {
  adopt_orphans();
  const ChildProcess running(shell("exec sleep 600"));
  const auto numbers = scratch_.path("numbers");
  const auto daemon = [&](const std::string& trap) {
    return "(setsid sh -c '" + trap + " echo $$ >>" + numbers.string() +
           "; while :; do :; done' &)\n";
  };
  // The shell ends when both have their sessions, because its process group ends with it.
  run(shell(daemon("") + daemon("trap \"\" TERM;") + "until [ \"$(wc -l <" + numbers.string() +
            ")\" = 2 ]; do :; done"));
  std::istringstream text(read_whole(numbers));
  const std::vector<pid_t> daemons(std::istream_iterator<pid_t>(text), {});
  ASSERT_EQ(daemons.size(), 2U);
  end_orphans(std::chrono::milliseconds(1));
  for (const pid_t process : daemons) EXPECT_EQ(kill(process, 0), -1);
  EXPECT_EQ(kill(running.pid(), 0), 0);
}

TEST_F(Child, RefusesWhatCannotBeStarted) {
  const auto error_of = [](const ChildCommand& command) {
    return thrown_error(ErrorCode::kSetup, [&] { ChildProcess{command}; });
  };
  ChildCommand text = shell(""), nowhere = shell("true"), no_log = shell("true");
  text.arguments = {scratch_.write("text", "no program")};
  EXPECT_EQ(error_of(text).subject(), text.arguments[0]);
  std::filesystem::permissions(text.arguments[0], std::filesystem::perms::owner_all);
  EXPECT_NE(std::string(error_of(text).what()).find("uname -m"), std::string::npos);
  ChildCommand script = shell("");
  script.arguments = {scratch_.write("script", "#!/none/interpreter\n")};
  std::filesystem::permissions(script.arguments[0], std::filesystem::perms::owner_all);
  EXPECT_NE(std::string(error_of(script).what()).find("interpreter"), std::string::npos);
  nowhere.working_folder = scratch_.path("none");
  EXPECT_EQ(std::filesystem::path(error_of(nowhere).subject()).filename(), "sh");
  no_log.log = scratch_.path("none/log");
  EXPECT_EQ(error_of(no_log).where().file, no_log.log);
}

}  // namespace
}  // namespace tether::os
