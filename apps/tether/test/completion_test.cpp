#include "shared/completion.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>

// What shells make of the scripts. bash is on every machine that builds Tether; zsh and fish are
// asked if they are there.
namespace tether::app {
namespace {

class Completion : public testing::Test {
 protected:
  Completion() {
    program_.name("demo-1");
    CLI::App* run = program_.add_subcommand("run", "Run one trial. More");
    run->add_option("--format", text_, "It's a format")->check(CLI::IsMember({"text", "html"}));
    run->add_option("--out", text_, "A folder");
    run->add_option("--target", text_, "A target");
    run->add_flag("--force", flag_, "Replace");
    run->add_option("scenario", text_, "A scenario");
    CLI::App* world = program_.add_subcommand("world", "Check worlds");
    world->add_subcommand("check", "Check a world")->add_flag("--tolerant", flag_, "Correct");
    add_completion_command(program_, text_);
    folder_.write("in here.toml", "");
    // What `PROGRAM list` prints.
    const std::string program = folder_.write(
        "demo-1",
        "#!/bin/sh\nprintf 'scenarios\\n  face_anchor  Turns\\n\\ntargets\\n  pi  A\\n'\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  }

  /// What the shell prints; the script is in the file "script".
  std::string output_of(const std::string& shell, const std::string& code) {
    folder_.write("script", completion_script(program_, shell));
    folder_.write("code", code);
    const std::string out = folder_.path("out");
    const std::string run = "cd '" + folder_.path().string() + "' && PATH=\"$PWD:$PATH\" " + shell +
                            " code > '" + out + "' 2>&1";
    EXPECT_EQ(std::system(run.c_str()), 0) << os::read_file(out);
    return os::read_file(out);
  }
  /// Completions of bash for the words, the last of which is incomplete; each with a blank after
  /// it.
  std::string in_bash(const std::string& words) {
    return output_of("bash", "source ./script\nCOMP_WORDS=(" + words +
                                 ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_demo_1\n"
                                 "echo \"${COMPREPLY[@]}\"\n");
  }
  static bool has(const char* shell) {
    return std::system((std::string("command -v ") + shell + " > /dev/null").c_str()) == 0;
  }

  ScratchFolder folder_;
  CLI::App program_;
  std::string text_;
  bool flag_ = false;
};

TEST_F(Completion, OfBashHasCommandsOptionsChoicesAndShippedNames) {
  EXPECT_EQ(in_bash("demo-1 ''"), "run world completion --help\n");
  EXPECT_EQ(in_bash("demo-1 wo"), "world\n");
  EXPECT_EQ(in_bash("demo-1 world ''"), "check --help\n");
  EXPECT_EQ(in_bash("demo-1 world check --t"), "--tolerant\n");
  EXPECT_EQ(in_bash("demo-1 run --fo"), "--format --force\n");
  EXPECT_EQ(in_bash("demo-1 run --format ''"), "text html\n");
  EXPECT_EQ(in_bash("demo-1 run --out ''"), "\n");  // file names, which bash adds
  EXPECT_EQ(in_bash("demo-1 run --target ''"), "pi\n");
  EXPECT_EQ(in_bash("demo-1 run fa"), "face_anchor\n");
  EXPECT_EQ(in_bash("demo-1 completion z"), "zsh\n");
}

TEST_F(Completion, OfFishHasThem) {
  if (!has("fish")) GTEST_SKIP() << "fish is not installed";
  const auto in_fish = [&](const std::string& line) {
    return output_of("fish", "source ./script\ncomplete --do-complete '" + line + "'\n");
  };
  EXPECT_EQ(in_fish("demo-1 wo"), "world\tCheck worlds\n");
  EXPECT_EQ(in_fish("demo-1 world ch"), "check\tCheck a world\n");
  EXPECT_EQ(in_fish("demo-1 run --fo"), "--force\tReplace\n--format\tIt's a format\n");
  EXPECT_EQ(in_fish("demo-1 run --format h"), "html\tIt's a format\n");
  EXPECT_EQ(in_fish("demo-1 run --target p"), "pi\tA target\n");
  EXPECT_EQ(in_fish("demo-1 run fa"), "face_anchor\n");
  EXPECT_EQ(in_fish("demo-1 completion z"), "zsh\n");
}

TEST_F(Completion, OfZshHasThem) {
  if (!has("zsh")) GTEST_SKIP() << "zsh is not installed";
  // What it would offer, instead of the functions of an interactive zsh.
  const auto in_zsh = [&](const std::string& line) {
    return output_of("zsh",
                     "compadd() { print -r -- \"${@:2}\" }\n_files() { print files }\n"
                     "_describe() { print -rl -- \"${(@P)2}\" }\n"
                     "words=(" +
                         line +
                         ") CURRENT=${#words} PREFIX=${words[-1]}\n"
                         "ask() { source ./script }\nask\n");
  };
  EXPECT_EQ(in_zsh("demo-1 wo"),
            "run:Run one trial\nworld:Check worlds\n"
            "completion:Print the script with which a shell completes this program's words\n"
            "files\n");
  EXPECT_EQ(in_zsh("demo-1 world check --"),
            "--help:Print this help message and exit\n--tolerant:Correct\n");
  EXPECT_EQ(in_zsh("demo-1 run --format ''"), "text html\n");
  EXPECT_EQ(in_zsh("demo-1 run --out ''"), "files\n");
  EXPECT_EQ(in_zsh("demo-1 run --target ''"), "pi\nfiles\n");
  EXPECT_EQ(in_zsh("demo-1 run fa"), "face_anchor\nfiles\n");
}

}  // namespace
}  // namespace tether::app
