#include "support/gazebo.h"

#include "support/gzserver.h"

#include <csignal>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

/// Real Gazebo, of build/gazebo-root or the system: flights, and what happens when it fails.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A machine with other things to do may take long for a first picture.
std::filesystem::path patient_hover(const std::filesystem::path& folder) {
  return write_hover_scenario(folder, "good", {{"hang_limit_s = 2", "hang_limit_s = 30"}});
}

class Gazebo : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto why = no_gzserver()) GTEST_SKIP() << *why;
  }
  Output fly(const std::filesystem::path& scenario, const Variables& variables = {}) {
    return run(gazebo_run(scenario, folder_ / "out", variables, mark_), 100s);
  }
  std::filesystem::path hover() { return patient_hover(folder_.path()); }
  std::string log() { return read_text(folder_ / "out/simulator.log"); }
  /// What a failure must show; returns its reason.
  std::string expect_failure(const Output& output, const std::string& end) {
    EXPECT_EQ(output.code, 3) << log();
    const auto result = read_result(folder_ / "out");
    EXPECT_EQ(result["end"], end);
    EXPECT_THAT(output.err, HasSubstr("tether: " + result["reason"].get<std::string>()));
    EXPECT_TRUE(wait_until_gone(mark_));
    return result["reason"];
  }

  const std::string mark_ =
      std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
      std::to_string(getpid());
  TempFolder folder_;
};

// ---- Flights

TEST_F(Gazebo, FliesAndLeavesNothing) {
  const Output output = fly(hover(), {{"USER", mark_}});
  ASSERT_EQ(output.code, 0) << output.err << log();
  EXPECT_EQ(output.err, "");
  EXPECT_THAT(read_result(folder_ / "out")["versions"]["simulator"].get<std::string>(),
              StartsWith("Gazebo 11"));
  const Output audit = run(tether({"audit", folder_ / "out/record.mcap"}));
  EXPECT_EQ(audit.code, 0) << audit.out;
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(private_folder(folder_ / "out")));
  // Where Gazebo would keep its shaders.
  EXPECT_FALSE(std::filesystem::exists("/tmp/gazebo-" + mark_ + "-rtshaderlibcache"));
}

TEST_F(Gazebo, ShowsTheAnchorToATask) {
  const Output output = fly(write_face_scenario(folder_.path()));
  EXPECT_EQ(output.code, 0) << output.err << log();
  const Output audit = run(tether({"audit", folder_ / "out/record.mcap"}));
  EXPECT_EQ(audit.code, 0) << audit.out;
}

TEST_F(Gazebo, FliesTwoRunsAtOnce) {
  const TempFolder other;
  Process first(gazebo_run(hover(), folder_ / "out", {}, mark_));
  Process second(gazebo_run(patient_hover(other.path()), other / "out", {}, mark_));
  EXPECT_EQ(first.wait(100s).code, 0) << log();
  EXPECT_EQ(second.wait(100s).code, 0) << read_text(other / "out/simulator.log");
  EXPECT_NE(private_folder(folder_ / "out"), private_folder(other / "out"));
  EXPECT_TRUE(wait_until_gone(mark_));
}

// ---- Failures

struct Blow {
  std::string name;
  std::string process;  ///< a word of its command line
  int signal;
  std::vector<std::string> reason;  ///< parts of it
  int hang_limit_s = 30;
};

void PrintTo(const Blow& blow, std::ostream* out) {
  *out << blow.name;
}

class StruckGazebo : public Gazebo, public testing::WithParamInterface<Blow> {};

TEST_P(StruckGazebo, EndsTheRunWithItsReason) {
  EndlessFlight flight(folder_.path(), {}, mark_, GetParam().hang_limit_s);
  const auto process = find_process(mark_, GetParam().process);
  ASSERT_TRUE(process);
  kill(*process, GetParam().signal);
  const std::string reason = expect_failure(flight.process().wait(40s), "simulator_lost");
  for (const std::string& part : GetParam().reason) EXPECT_THAT(reason, HasSubstr(part));
  EXPECT_EQ(read_record(flight.out()).damage, "");
  EXPECT_FALSE(std::filesystem::exists(private_folder(flight.out())));
}

const Blow kBlows[] = {
    {"killed", "gzserver", SIGKILL, {"signal 9"}},
    {"crashed", "gzserver", SIGSEGV, {"signal 11"}},
    {"stopped", "gzserver", SIGSTOP, {"4 s"}, 4},
    {"blinded", "Xvfb", SIGKILL, {"signal 9"}},
};

INSTANTIATE_TEST_SUITE_P(Blows, StruckGazebo, testing::ValuesIn(kBlows),
                         [](const auto& blow) { return blow.param.name; });

/// Holds a TCP port.
class TakenPort {
 public:
  TakenPort() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, generic, size) != 0 || listen(socket_, 1) != 0 ||
        getsockname(socket_, generic, &size) != 0)
      throw std::runtime_error("no port");
    number_ = ntohs(address.sin_port);
  }
  ~TakenPort() { close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;
  int number() const { return number_; }

 private:
  int socket_;
  int number_ = 0;
};

TEST_F(Gazebo, WhosePortIsInUseSaysSo) {
  const TakenPort port;
  const std::string master = "http://127.0.0.1:" + std::to_string(port.number());
  const Output output = fly(hover(), {{"GAZEBO_MASTER_URI", master}});
  EXPECT_THAT(expect_failure(output, "setup_failed"), HasSubstr(master));
}

TEST_F(Gazebo, WithoutItsPluginDoesNotKeepAnyoneWaiting) {
  write_text(folder_ / "plugin.so", "no library");
  const Output output = fly(hover(), {{"TETHER_GAZEBO_PLUGIN", folder_ / "plugin.so"}});
  EXPECT_THAT(expect_failure(output, "setup_failed"),
              AllOf(HasSubstr("Failed to load plugin"), HasSubstr("plugin.so")));
}

/// Links to what is in `from`, but for what has that name.
void link_all(const std::filesystem::path& from, const std::filesystem::path& to,
              const std::string& but) {
  std::filesystem::create_directories(to);
  for (const auto& entry : std::filesystem::directory_iterator(from))
    if (entry.path().filename() != but)
      std::filesystem::create_symlink(entry.path(), to / entry.path().filename());
}

/// The root in use, without the drivers that draw; none where Gazebo is the system's.
std::optional<std::filesystem::path> root_without_gl(const std::filesystem::path& folder) {
  const char* given = std::getenv("TETHER_GAZEBO_ROOT");
  const std::filesystem::path root = given ? given : TETHER_SOURCE_DIR "/build/gazebo-root";
  if (!std::filesystem::exists(root)) return std::nullopt;
  const std::string machine = "x86_64-linux-gnu";
  link_all(root, folder, "usr");
  link_all(root / "usr", folder / "usr", "lib");
  link_all(root / "usr/lib", folder / "usr/lib", machine);
  link_all(root / "usr/lib" / machine, folder / "usr/lib" / machine, "dri");
  return folder;
}

TEST_F(Gazebo, WithoutGlSaysSo) {
  const auto root = root_without_gl(folder_ / "root");
  if (!root) GTEST_SKIP() << "Gazebo is the system's";
  const Output output = fly(hover(), {{"TETHER_GAZEBO_ROOT", *root}});
  EXPECT_THAT(expect_failure(output, "setup_failed"), HasSubstr("camera"));
}

TEST_F(Gazebo, EndsWithATetherThatIsKilled) {
  EndlessFlight flight(folder_.path(), {}, mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(has_x_lock(*x_server));
}

TEST_F(Gazebo, EndsWithCtrlC) {
  EndlessFlight flight(folder_.path(), {}, mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGINT);
  EXPECT_EQ(flight.process().wait(20s).code, 3);
  EXPECT_EQ(read_result(flight.out())["end"], "interrupted");
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(has_x_lock(*x_server));
  EXPECT_FALSE(std::filesystem::exists(private_folder(flight.out())));
}

}  // namespace
}  // namespace tether::system_test
