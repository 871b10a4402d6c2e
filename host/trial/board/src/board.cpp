#include "board_scripts.h"
#include "sut_script.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/board/board.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/interrupt.h>
#include <tether/os/text_file.h>

/// A board for one run. A shell on the board, the keeper (board_keeper.sh), takes the lock, and
/// ends and removes everything of the run when this process or the connection ends; a heartbeat
/// over its standard input shows that this process exists. SUTs and copies of files use further
/// commands over the same connection.
namespace tether::board {

namespace {

using Steady = std::chrono::steady_clock;

constexpr Duration kHoldLimit = std::chrono::seconds(20);
constexpr Duration kCopyLimit = std::chrono::minutes(5);
// One second for SIGTERM, one for SIGKILL, and the round trip.
constexpr Duration kEndLimit = std::chrono::seconds(8);
constexpr Duration kHeartbeat = std::chrono::seconds(1);
constexpr Duration kKeeperPoll = std::chrono::milliseconds(5);
// How long the end of a connection may take to show.
constexpr Duration kShowLimit = std::chrono::milliseconds(300);
// The keeper first ends the SUTs, which takes up to two seconds.
constexpr Duration kKeeperLimit = std::chrono::milliseconds(2500);
constexpr int kLargestReturn_KiB = 256 * 1024;
constexpr int kNotStarted = 120, kSshFailed = 255;

constexpr std::string_view kCopyScript = R"script(umask 077
mkdir -p "$folder/files/$number" && cat >"$folder/files/$number/$name" &&
  [ "$(wc -c <"$folder/files/$number/$name")" -eq "$size" ] || exit 1
)script";
constexpr std::string_view kReturnScript = R"script(cd "$folder/out.$uav" 2>/dev/null || exit 0
[ -n "$(ls -A)" ] || exit 0
[ "$(du -sk . | cut -f 1)" -le "$largest" ] || { echo "more than $largest KiB" >&2; exit 1; }
exec tar -cf - .
)script";

os::Pipe open_pipe() {
  os::Pipe pipe = os::make_pipe();
  if (!pipe.read_end) throw Error(ErrorCode::kSetup, "pipe: " + reason_of(errno));
  return pipe;
}

/// Shown to other runs while the board is reserved.
std::string describe_this_run() {
  const char* user = std::getenv("USER");
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format(
      "{}@{} (tether, pid {}), since {:%Y-%m-%d %H:%M:%S} UTC", user && *user ? user : "unknown",
      host, getpid(),
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

Board::Board(const scenario::SshAddress& address, std::stop_token stop)
    : connection_(address, std::move(stop)) {
  hold();
  heartbeat_ = std::jthread([this](const std::stop_token& ended) { send_heartbeat(ended); });
}

Board::~Board() {
  heartbeat_.request_stop();
  heartbeat_.join();
  to_keeper_ = os::FileDescriptor();
  keeper_->wait(kEndLimit);
}

/// Without it, the keeper releases the board.
void Board::send_heartbeat(const std::stop_token& stop) const {
  do {
    os::write_all(to_keeper_, "\n");
    os::sleep_unless_stopped(kHeartbeat, stop);
  } while (!stop.stop_requested());
}

std::string Board::keeper_output() const {
  return os::read_whole(connection_.folder() / "keeper.out");
}

bool Board::wait_for_keeper(const std::string& word, Duration limit) {
  const auto started = Steady::now();
  while (Steady::now() - started < limit) {
    const bool has_ended = keeper_->poll().has_value();
    const std::string said = keeper_output();
    const auto at = said.find(word);
    if (at != std::string::npos && said.find('\n', at) != std::string::npos) return true;
    if (has_ended) return false;
    std::this_thread::sleep_for(kKeeperPoll);
  }
  return false;
}

void Board::hold() {
  const std::string script = assign("who", describe_this_run()) + std::string(kBoardKeeper);
  os::Pipe pipe = open_pipe();
  const auto& folder = connection_.folder();
  keeper_ = std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = connection_.shell(script.size()),
                       .environment = {},
                       .log = folder / "keeper.out",
                       .errors = folder / "keeper.err",
                       .input_pipe = pipe.read_end.get()});
  pipe.read_end = os::FileDescriptor();
  to_keeper_ = std::move(pipe.write_end);
  os::write_all(to_keeper_, script);

  const bool answered = wait_for_keeper("held ", kHoldLimit);
  const std::string where = scenario::to_string(connection_.address());
  const std::string said = os::last_line(keeper_output());
  if (said.starts_with("busy "))
    throw Error(ErrorCode::kSetup,
                fmt::format("{} is in use by {}; wait for that run to end, or end it", where,
                            said.substr(5)))
        .about(where);
  if (!answered)
    throw Error(
        ErrorCode::kSetup,
        fmt::format("cannot reserve {}: {}", where,
                    said.empty() ? os::last_line(os::read_whole(folder / "keeper.err")) : said))
        .about(where);
  std::istringstream words(said);
  std::string held;
  words >> held >> host_address_ >> std::ws;
  std::getline(words, folder_);
}

std::string Board::prologue() const {
  return assign("folder", folder_);
}

std::string Board::copy(const std::filesystem::path& file) {
  const std::string bytes = os::read_whole(file);
  const std::string number = std::to_string(++copies_), name = file.filename().string();
  const std::string script = prologue() + assign("number", number) + assign("name", name) +
                             assign("size", std::to_string(bytes.size())) +
                             std::string(kCopyScript);
  const os::Captured copied = connection_.run(script, kCopyLimit, bytes);
  if (copied.code != 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("cannot copy {} to {}: {}", file.string(),
                            scenario::to_string(connection_.address()), os::last_line(copied.err)))
        .about(file.string());
  return fmt::format("{}/files/{}/{}", folder_, number, name);
}

std::unique_ptr<os::ChildProcess> Board::start(const BoardSut& sut) {
  const std::string script = prologue() + sut_prologue(sut) + std::string(kBoardSut);
  // In memory, because the script contains the token.
  const os::MemoryFile input(script);
  return std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = connection_.shell(script.size()),
                       .environment = {},
                       .log = sut.log,
                       .input = input.path()});
}

SutEnd Board::end_of(const os::ChildExit& exit, const std::string& last_line) {
  constexpr std::string_view kOwn = "tether: ";
  if (exit.code == kSshFailed)
    if (const auto why = connection_.lost(kShowLimit))
      return {SutEndCause::kConnection, "was disconnected: " + *why};
  if (exit.code == kNotStarted && last_line.starts_with(kOwn))
    return {SutEndCause::kNotStarted, "could not be started: " + last_line.substr(kOwn.size())};
  const int signal = exit.code - os::kSignalled;
  const bool may_be_keepers = signal == SIGTERM || signal == SIGKILL;
  if ((may_be_keepers || signal <= 0) && keeper_->wait(may_be_keepers ? kKeeperLimit : kShowLimit))
    return {SutEndCause::kBoard, "was ended because " + describe_release()};
  if (signal > 0 && signal < NSIG)
    return {SutEndCause::kItself, "was ended by " + name_of_signal(signal)};
  return {SutEndCause::kItself, exit.description};
}

std::string Board::describe_release() const {
  const std::string said = os::last_line(os::read_whole(connection_.folder() / "keeper.err"));
  return fmt::format("{} is no longer reserved for this run: {}",
                     scenario::to_string(connection_.address()),
                     said.empty() ? "its shell on the board was ended" : said);
}

std::optional<std::string> Board::lost() {
  const bool is_held = !keeper_->poll();
  if (const auto why = connection_.lost(is_held ? Duration(0) : kShowLimit)) return why;
  if (is_held) return std::nullopt;
  return describe_release();
}

bool Board::end_suts() {
  if (lost()) return false;
  os::write_all(to_keeper_, "stop\n");
  return wait_for_keeper("stopped", kEndLimit);
}

std::optional<std::string> Board::bring_back(const std::string& uav,
                                             const std::filesystem::path& folder) {
  const std::string script = prologue() + assign("uav", uav) +
                             assign("largest", std::to_string(kLargestReturn_KiB)) +
                             std::string(kReturnScript);
  const os::Captured files = connection_.run(script, kCopyLimit, {}, true);
  const auto failed = [&](const std::string& why) {
    return fmt::format(
        "cannot copy the files that the SUT of UAV \"{}\" wrote to TETHER_OUT from {}: {}", uav,
        scenario::to_string(connection_.address()), why);
  };
  if (files.code != 0) return failed(os::last_line(files.err));
  if (files.out.empty()) return std::nullopt;
  // A SUT must not replace files that this machine writes to the folder.
  const os::Captured unpacked =
      os::run_captured({"tar", "-x", "-f", "-", "--no-same-owner", "--exclude=./record.mcap",
                        "--exclude=./result.json", "--exclude=./sut-*.log",
                        "--exclude=./exec-*.log", "-C", folder.string()},
                       files.out, kCopyLimit);
  if (unpacked.code != 0) return failed(os::last_line(unpacked.err));
  return std::nullopt;
}

}  // namespace tether::board
