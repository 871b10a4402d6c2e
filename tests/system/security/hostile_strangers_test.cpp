#include "support/memory_watch.h"
#include "support/raw_peer.h"
#include "support/trials.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <tether/link/codec.h>

/// Peers that do not belong to a run: rejected within bounded time and memory, while the run ends
/// with the same bytes as alone. What the server replies to each:
/// common/link/test/tcp_server_attack_test.cpp, tcp_server_test.cpp.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

link::Hello hello_with(const std::string& token) {
  link::Hello hello;
  hello.sut = "hostile";
  hello.clock = {computer::ClockKind::kScripted, 1.0, 2ms};
  hello.token = token;
  return hello;
}

/// Attacks an address until `over`; may end before.
using Act = std::function<void(const std::string& address, const std::atomic<bool>& over)>;

struct Attack {
  std::string name;
  Act act;
};

void PrintTo(const Attack& attack, std::ostream* out) {
  *out << attack.name;
}

/// Connection after connection, each of which does `act` with its number; the last `kept` of them
/// stay open.
Attack again_and_again(const std::string& name, std::size_t kept,
                       const std::function<void(RawPeer&, std::size_t)>& act) {
  return {name, [=](const std::string& address, const std::atomic<bool>& over) {
            std::vector<std::unique_ptr<RawPeer>> peers(kept);
            std::size_t connections = 0;
            for (; !over; ++connections) {
              auto& peer = peers[connections % kept];
              try {
                peer = std::make_unique<RawPeer>(address);
              } catch (const std::runtime_error&) {
                break;  // the run has ended
              }
              act(*peer, connections);
              std::this_thread::sleep_for(1ms);
            }
            EXPECT_GT(connections, 20u);
          }};
}

const std::string kGarbage[] = {
    "GET / HTTP/1.1\r\nHost: tether\r\n\r\n",
    std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11),
    std::string(4, '\0'),
    std::string("\x40\x00\x00\x00", 4) + std::string(64, 'x'),
    std::string("\xff\xff\xff\xff", 4) + std::string(60'000, 'x'),  // 4 GiB announced
    std::string("\x00\x10\x00\x00", 4) + std::string(4095, 'x'),    // all but the last byte
    frame_of(link::Progress{}),
    frame_of(link::Reply{1, ExecTime{}, std::nullopt}),
};

const Attack kAttacks[] = {
    {"Hundreds of silent connections",
     [](const std::string& address, const std::atomic<bool>& over) {
       std::vector<std::unique_ptr<RawPeer>> peers;
       for (int i = 0; i < 300; ++i) peers.push_back(std::make_unique<RawPeer>(address));
       while (!over) std::this_thread::sleep_for(5ms);
     }},
    again_and_again(
        "Garbage", 50,
        [](RawPeer& peer, std::size_t i) { peer.write(kGarbage[i % std::size(kGarbage)]); }),
    again_and_again("Guessed tokens", 50,
                    [](RawPeer& peer, std::size_t i) {
                      std::string token = ExternalRun::token();
                      token[i % token.size()] ^= 1;
                      peer.write(hello_with(i % 3 == 0 ? "" : token));
                    }),
    again_and_again("Connections that come and go", 1,
                    [](RawPeer& peer, std::size_t i) {
                      if (i % 2 == 0) peer.reset_at_close();
                      if (i % 3 == 0) peer.write("\x10");
                    }),
    again_and_again("Connections closed on one side", 60,
                    [](RawPeer& peer, std::size_t i) {
                      const std::string frame = frame_of(hello_with("wrong"));
                      if (i % 3 > 0) peer.write(frame.substr(0, frame.size() - i % 3 + 1));
                      peer.shut(i % 2 == 0 ? SHUT_WR : SHUT_RD);
                    }),
    // Rejected after its first frame, it goes on.
    {"A flood without a Hello",
     [](const std::string& address, const std::atomic<bool>& over) {
       std::string flood;
       for (int i = 0; i < 1000; ++i) flood += frame_of(link::Progress{});
       int floods = 0;
       while (!over) {
         const RawPeer peer(address);
         while (!over && peer.write(flood)) ++floods;
       }
       EXPECT_GT(floods, 20);
     }},
};

class Strangers : public testing::TestWithParam<Attack> {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    scenario_ = write_hover_scenario(folder_->path(), "good", {kScripted});
    memory_alone_KiB_ = fly("alone", {}, [](const auto&, const auto&) {});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  /// A run of the good SUT under a scripted clock, and an attack that begins before the SUT joins.
  /// Returns the largest memory of `tether`.
  static long fly(const std::string& out, const std::vector<std::string>& options,
                  const Act& attack) {
    ExternalRun run(scenario_, *folder_ / out, options);
    std::atomic<bool> over = false;
    std::jthread attacker([&] {
      try {
        attack(run.address(), over);
      } catch (const std::runtime_error&) {  // the run has ended
      }
    });
    const MemoryWatch memory(run.process().pid());
    const auto sut = run.start_sut({bad_sut_program(), "good"});
    EXPECT_TRUE(sut->wait_for_out("joined", 30s)) << sut->err();
    const Output tether = run.wait();
    over = true;
    EXPECT_EQ(tether.code, 0) << tether.err;
    // Hundreds of rejections do not fill the terminal.
    EXPECT_LE(std::count(tether.err.begin(), tether.err.end(), '\n'), 30);
    EXPECT_EQ(sut->wait(5s).code, 0);
    return memory.most_KiB();
  }

  static inline std::unique_ptr<TempFolder> folder_;
  static inline std::filesystem::path scenario_;
  static inline long memory_alone_KiB_ = 0;
};

TEST_P(Strangers, ChangeNothing) {
  // Paced, so that there is time to disturb it.
  const long memory_KiB = fly("attacked", {"--real-time-factor", "1"}, GetParam().act);
  expect_same_runs(*folder_ / "alone", *folder_ / "attacked");
  if (kMemoryIsTethers) {
    EXPECT_LT(memory_KiB, memory_alone_KiB_ + kMostExtraMemory_KiB);
  }
}

INSTANTIATE_TEST_SUITE_P(Attacks, Strangers, testing::ValuesIn(kAttacks), [](const auto& attack) {
  std::string name = attack.param.name;
  std::erase(name, ' ');
  return name;
});

/// A SUT whose UAV is taken, and a Hello with the token of an earlier run.
TEST(Hello, IsRefusedForAUavThatIsTakenAndInALaterRun) {
  const TempFolder folder;
  const auto scenario = write_hover_scenario(folder.path(), "good", {kScripted});
  std::string recorded;
  for (const char* out : {"first", "second"}) {
    Process process(with(tether({"run", scenario, "--target", "wait", "--out", folder / out}), {},
                         {{"TETHER_TOKEN", ""}}));
    ASSERT_TRUE(process.wait_for_err("bad_sut good", 30s)) << process.err();
    const std::string printed = process.err();
    const auto value = [&](const std::string& key) {
      const auto begin = printed.find(key) + key.size();
      return printed.substr(begin, printed.find(' ', begin) - begin);
    };
    const std::string own = frame_of(hello_with(value("TETHER_TOKEN=")));
    RawPeer replayed(value("TETHER_ADDRESS="));
    replayed.write(recorded.empty() ? frame_of(hello_with("")) : recorded);
    EXPECT_NE(replayed.read_refusal(20s), "");
    recorded = own;
    RawPeer first(value("TETHER_ADDRESS=")), second(value("TETHER_ADDRESS="));
    first.write(own);
    EXPECT_TRUE(std::holds_alternative<link::Welcome>(first.read(20s).value()));
    second.write(own);
    EXPECT_NE(second.read_refusal(20s), "");
    EXPECT_FALSE(process.has_ended());
  }
}

}  // namespace
}  // namespace tether::system_test
