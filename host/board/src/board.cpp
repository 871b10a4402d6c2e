
#include "board_scripts.h"
#include "sut_script.h"

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <sstream>
#include <string_view>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>
#include <tether/board/board.h>
#include <tether/os/captured_run.h>
#include <tether/os/child_process.h>
#include <tether/os/memory_file.h>
#include <tether/os/text_file.h>

namespace tether::board {

namespace {

using Steady = std::chrono::steady_clock;

constexpr Duration kHoldLimit = std::chrono::seconds(20);
constexpr Duration kCopyLimit = std::chrono::minutes(5);
// Ending is a second of asking, a second of making, and the way there.
constexpr Duration kEndLimit = std::chrono::seconds(8);
constexpr Duration kHeartbeat = std::chrono::seconds(1);
constexpr Duration kKeeperLook = std::chrono::milliseconds(5);
// How long a connection that has ended may take to show it.
constexpr Duration kShowLimit = std::chrono::milliseconds(300);
// The keeper ends the SUTs before it ends itself, which takes it up to two seconds.
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

std::string who_runs() {
  const char* user = std::getenv("USER");
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return fmt::format(
      "{}@{} (tether, pid {}), since {:%Y-%m-%d %H:%M:%S} UTC", user && *user ? user : "somebody",
      host, getpid(),
      fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
}

}  // namespace

Board::Board(const scenario::SshAddress& address, std::stop_token stop)
    : connection_(address, std::move(stop)) {
  hold();
  heart_ = std::jthread([this](const std::stop_token& ended) { beat(ended); });
}

Board::~Board() {
  heart_.request_stop();
  heart_.join();
  to_keeper_ = os::FileDescriptor();
  keeper_->wait(kEndLimit);
}

/// The keeper lets go of the board where this stays away.
void Board::beat(const std::stop_token& stop) const {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any stopped;
  do {
    os::write_all(to_keeper_, "\n");
  } while (!stopped.wait_for(lock, stop, kHeartbeat, [&] { return stop.stop_requested(); }));
}

std::string Board::keeper_said() const {
  return os::read_whole(connection_.folder() / "keeper.out");
}

bool Board::wait_for_keeper(const std::string& word, Duration limit) {
  const auto started = Steady::now();
  while (Steady::now() - started < limit) {
    const bool last_look = keeper_->poll().has_value();
    const std::string said = keeper_said();
    const auto at = said.find(word);
    if (at != std::string::npos && said.find('\n', at) != std::string::npos) return true;
    if (last_look) return false;
    std::this_thread::sleep_for(kKeeperLook);
  }
  return false;
}

void Board::hold() {
  const std::string script = assign("who", who_runs()) + std::string(kBoardKeeper);
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
  const std::string said = os::last_line(keeper_said());
  if (said.starts_with("busy "))
    throw Error(ErrorCode::kSetup,
                fmt::format("{} is in use by {}; wait for that run to end, or end it", where,
                            said.substr(5)));
  if (!answered)
    throw Error(
        ErrorCode::kSetup,
        fmt::format("{} cannot be held: {}", where,
                    said.empty() ? os::last_line(os::read_whole(folder / "keeper.err")) : said));
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
                fmt::format("{} cannot be copied to {}: {}", file.string(),
                            scenario::to_string(connection_.address()), os::last_line(copied.err)));
  return fmt::format("{}/files/{}/{}", folder_, number, name);
}

std::unique_ptr<os::ChildProcess> Board::start(const BoardSut& sut) {
  const std::string script = prologue() + sut_prologue(sut) + std::string(kBoardSut);
  // A file on the disk would leave the token there.
  const os::MemoryFile input(script);
  auto process = std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = connection_.shell(script.size()),
                       .environment = {},
                       .log = sut.log,
                       .input = input.path()});
  return process;
}

SutEnd Board::end_of(const os::ChildExit& exit, const std::string& last_words) {
  constexpr std::string_view kOwn = "tether: ";
  if (exit.code == kSshFailed)
    if (const auto why = connection_.lost(kShowLimit))
      return {SutEndCause::kConnection, "was cut off: " + *why};
  if (exit.code == kNotStarted && last_words.starts_with(kOwn))
    return {SutEndCause::kNotStarted, "could not be started: " + last_words.substr(kOwn.size())};
  const int signal = exit.code - os::kSignalled;
  const bool may_be_keepers = signal == SIGTERM || signal == SIGKILL;
  if ((may_be_keepers || signal <= 0) && keeper_->wait(may_be_keepers ? kKeeperLimit : kShowLimit))
    return {SutEndCause::kBoard, "was ended because " + let_go()};
  if (signal > 0 && signal < NSIG)
    return {SutEndCause::kItself, "was ended by " + name_of_signal(signal)};
  return {SutEndCause::kItself, exit.description};
}

std::string Board::let_go() const {
  const std::string said = os::last_line(os::read_whole(connection_.folder() / "keeper.err"));
  return fmt::format("{} is no longer held for this run: {}",
                     scenario::to_string(connection_.address()),
                     said.empty() ? "the shell that held it there was ended" : said);
}

std::optional<std::string> Board::lost() {
  const bool is_held = !keeper_->poll();
  if (const auto why = connection_.lost(is_held ? Duration(0) : kShowLimit)) return why;
  if (is_held) return std::nullopt;
  return let_go();
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
    return fmt::format("what the SUT of UAV \"{}\" wrote into TETHER_OUT stays behind on {}: {}",
                       uav, scenario::to_string(connection_.address()), why);
  };
  if (files.code != 0) return failed(os::last_line(files.err));
  if (files.out.empty()) return std::nullopt;
  // What this machine writes into the folder is not the SUT's to replace.
  const os::Captured unpacked =
      os::run_captured({"tar", "-x", "-f", "-", "--no-same-owner", "--exclude=./record.mcap",
                        "--exclude=./result.json", "--exclude=./sut-*.log", "-C", folder.string()},
                       files.out, kCopyLimit);
  if (unpacked.code != 0) return failed(os::last_line(unpacked.err));
  return std::nullopt;
}

}  // namespace tether::board
