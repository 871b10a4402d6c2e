#include "support/memory_watch.h"
#include "support/raw_peer.h"
#include "support/trials.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <tether/link/codec.h>

/// Peers that have no business in a run: refused with a reason within bounded time and memory,
/// while the run beside them ends with the same bytes as alone.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::SizeIs;

/// What a run had to bear, and what it came to.
struct Flight {
  Output tether;
  long memory_KiB = 0;
};

/// Does its worst until `over`; may end before.
using Attack = std::function<void(const std::string& address, const std::atomic<bool>& over)>;

link::Hello hello_with(const std::string& token) {
  link::Hello hello;
  hello.sut = "hostile";
  hello.clock = link::ClockKind::kScripted;
  hello.token = token;
  return hello;
}

class Strangers : public testing::Test {
 protected:
  /// A run of the good SUT under a scripted clock. The attack begins before the SUT comes.
  Flight fly(const std::string& out, const Attack& attack,
             const std::vector<std::string>& options) {
    ExternalRun run(scenario_, folder_ / out, options);
    std::atomic<bool> over = false;
    std::jthread attacker([&] {
      try {
        attack(run.address(), over);
      } catch (const std::runtime_error&) {  // it has ended: nobody listens any more
      }
    });
    const MemoryWatch memory(run.process().pid());
    const auto sut = run.start_sut({bad_sut_program(), "good"});
    EXPECT_TRUE(sut->wait_for_out("joined", 30s)) << sut->err();
    Output tether = run.wait();
    over = true;
    EXPECT_EQ(sut->wait(5s).code, 0);
    return {std::move(tether), memory.most_KiB()};
  }

  /// The run ends as alone, in no more memory.
  Output expect_harmless(const Attack& attack) {
    const Flight alone = fly("alone", [](const auto&, const auto&) {}, {});
    // Paced, so that there is time to disturb it.
    const Flight beside = fly("beside", attack, {"--real-time-factor", "1"});
    EXPECT_EQ(beside.tether.code, 0) << beside.tether.err;
    EXPECT_EQ(timeless_result(folder_ / "alone"), timeless_result(folder_ / "beside"));
    EXPECT_EQ(timeless_record(folder_ / "alone"), timeless_record(folder_ / "beside"));
    if (kMemoryIsTethers) {
      EXPECT_LT(beside.memory_KiB, alone.memory_KiB + kMostExtraMemory_KiB);
    }
    RecordProperty("memory_alone_KiB", std::to_string(alone.memory_KiB));
    RecordProperty("memory_beside_KiB", std::to_string(beside.memory_KiB));
    return beside.tether;
  }

  /// Over connection after connection does `act`, which gets the connection's number, and pauses;
  /// keeps the last `kept` of them open.
  Output expect_harmless_acting(const std::function<void(RawPeer&, std::size_t)>& act,
                                std::size_t kept, std::chrono::milliseconds pause = 1ms) {
    std::size_t connections = 0;
    const Output tether =
        expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
          std::vector<std::unique_ptr<RawPeer>> peers(kept);
          for (; !over; ++connections) {
            auto& peer = peers[connections % kept];
            peer = std::make_unique<RawPeer>(address);
            act(*peer, connections);
            std::this_thread::sleep_for(pause);
          }
        });
    EXPECT_GT(connections, 20u);
    return tether;
  }

  TempFolder folder_;
  std::filesystem::path scenario_ = write_hover_scenario(folder_.path(), "good");
};

TEST_F(Strangers, ThatConnectInHundredsAndSayNothing) {
  expect_harmless([](const std::string& address, const std::atomic<bool>& over) {
    std::vector<std::unique_ptr<RawPeer>> peers;
    for (int i = 0; i < 300; ++i) peers.push_back(std::make_unique<RawPeer>(address));
    while (!over) std::this_thread::sleep_for(5ms);
  });
}

TEST_F(Strangers, ThatSendAByteNowAndThen) {
  const std::string frame = frame_of(hello_with(std::string(200, 'x')));
  int taken = 0;
  expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
    std::vector<std::unique_ptr<RawPeer>> peers;
    for (int i = 0; i < 100; ++i) peers.push_back(std::make_unique<RawPeer>(address));
    for (std::size_t at = 0; !over && at < frame.size(); ++at) {
      for (const auto& peer : peers) taken += peer->write(frame.substr(at, 1)) ? 1 : 0;
      std::this_thread::sleep_for(50ms);
    }
  });
  EXPECT_GT(taken, 500);
}

/// The limit for a Hello is for all of it: five seconds from connecting.
TEST_F(Strangers, ThatSendAByteASecondAreToldAfterFive) {
  const ExternalRun run(scenario_, folder_ / "out");
  RawPeer slow(run.address());
  const std::string frame = frame_of(hello_with(ExternalRun::token()));
  const auto begin = std::chrono::steady_clock::now();
  std::string refusal;
  for (std::size_t at = 0; refusal.empty() && at < 30; ++at) {
    if (!slow.write(frame.substr(at, 1))) break;
    refusal = slow.read_refusal(1s);
  }
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - begin;
  EXPECT_NE(refusal, "");
  EXPECT_GT(waited.count(), 4.5);
  EXPECT_LT(waited.count(), 20);
}

TEST_F(Strangers, ThatAnnounceGigabytes) {
  const std::string bytes = std::string("\xff\xff\xff\xff", 4) + std::string(60'000, 'x');
  const Output tether =
      expect_harmless_acting([&](RawPeer& peer, std::size_t) { peer.write(bytes); }, 50);
  EXPECT_THAT(tether.err, HasSubstr("4294967295"));
}

/// What is announced is allowed, and never comes whole.
TEST_F(Strangers, ThatSendAllOfAFrameButItsLastByte) {
  const std::string bytes = std::string("\x00\x10\x00\x00", 4) + std::string(4095, 'x');
  expect_harmless_acting([&](RawPeer& peer, std::size_t) { peer.write(bytes); }, 200);
}

TEST_F(Strangers, ThatSendGarbage) {
  const std::string kinds[] = {
      "GET / HTTP/1.1\r\nHost: tether\r\n\r\n",
      std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11),
      std::string(4, '\0'),
      std::string("\x40\x00\x00\x00", 4) + std::string(64, 'x'),
      frame_of(link::Progress{}),
      frame_of(link::Reply{1, ExecTime{}, std::nullopt}),
  };
  int refused = 0;
  const Output tether =
      expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
        while (!over)
          for (const std::string& bytes : kinds) {
            RawPeer peer(address);
            peer.write(bytes);
            const std::string refusal = peer.read_refusal(10s);
            if (refusal.empty()) return;  // the run has ended
            ++refused;
          }
      });
  // Hundreds of refusals do not fill the terminal.
  EXPECT_GT(refused, 20);
  EXPECT_LE(std::count(tether.err.begin(), tether.err.end(), '\n'), 30);
}

TEST_F(Strangers, ThatGuessTokens) {
  std::vector<std::string> refusals;
  const Output tether =
      expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
        for (int i = 0; !over; ++i) {
          RawPeer guessing(address);
          std::string token = ExternalRun::token();
          token[static_cast<std::size_t>(i) % token.size()] ^= 1;
          guessing.write(hello_with(i % 3 == 0 ? "" : token));
          const std::string refusal = guessing.read_refusal(5s);
          if (refusal.empty()) return;  // the run has ended
          refusals.push_back(refusal);
        }
      });
  EXPECT_THAT(refusals, SizeIs(testing::Gt(10u)));
  EXPECT_THAT(tether.err, HasSubstr("token"));
}

TEST_F(Strangers, ThatHaveTheTokenOfAUavThatIsFlown) {
  std::vector<std::string> refusals;
  expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
    std::this_thread::sleep_for(1s);  // it must not come first
    while (!over) {
      RawPeer second(address);
      second.write(hello_with(ExternalRun::token()));
      refusals.push_back(second.read_refusal(5s));
    }
  });
  ASSERT_FALSE(refusals.empty());
}

TEST_F(Strangers, ThatComeAndGo) {
  expect_harmless_acting(
      [](RawPeer& passing, std::size_t i) {
        if (i % 2 == 0) passing.reset_at_close();
        if (i % 3 == 0) passing.write("\x10");
      },
      1, 0ms);
}

TEST_F(Strangers, ThatCloseHalf) {
  const std::string frame = frame_of(hello_with("wrong"));
  expect_harmless_acting(
      [&](RawPeer& peer, std::size_t i) {
        if (i % 3 > 0) peer.write(frame.substr(0, frame.size() - i % 3 + 1));
        peer.shut(i % 2 == 0 ? SHUT_WR : SHUT_RD);
      },
      60);
}

/// Sent away by its first frame, and going on nevertheless.
TEST_F(Strangers, ThatFloodWithoutAHello) {
  std::string flood;
  for (int i = 0; i < 1000; ++i) flood += frame_of(link::Progress{});
  int floods = 0;
  expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
    while (!over) {
      const RawPeer peer(address);
      while (!over && peer.write(flood)) ++floods;
    }
  });
  EXPECT_GT(floods, 20);
}

/// Its own token is worth nothing in the next run.
TEST_F(Strangers, ThatReplayTheHelloOfAnEarlierRun) {
  std::string recorded;
  for (const char* out : {"first", "second"}) {
    Command command = tether({"run", scenario_, "--target", "wait", "--out", folder_ / out});
    command.environment.emplace_back("TETHER_TOKEN", "");
    Process process(command);
    ASSERT_TRUE(process.wait_for_err("bad_sut good", 30s)) << process.err();
    const std::string said = process.err();
    const auto value = [&](const std::string& key) {
      const auto begin = said.find(key) + key.size();
      return said.substr(begin, said.find(' ', begin) - begin);
    };
    if (recorded.empty()) {
      recorded = frame_of(hello_with(value("TETHER_TOKEN=")));
      RawPeer welcome(value("TETHER_ADDRESS="));
      welcome.write(recorded);
      EXPECT_TRUE(std::holds_alternative<link::Welcome>(welcome.read(20s).value()));
    } else {
      RawPeer replayed(value("TETHER_ADDRESS="));
      replayed.write(recorded);
      EXPECT_THAT(replayed.read_refusal(20s), HasSubstr("token"));
      EXPECT_FALSE(process.has_ended());
    }
  }

  std::vector<std::string> refusals;
  expect_harmless([&](const std::string& address, const std::atomic<bool>& over) {
    while (!over) {
      RawPeer replayed(address);
      replayed.write(recorded);
      const std::string refusal = replayed.read_refusal(5s);
      if (refusal.empty()) return;  // the run has ended
      refusals.push_back(refusal);
    }
  });
  EXPECT_THAT(refusals, SizeIs(testing::Gt(10u)));
}

}  // namespace
}  // namespace tether::system_test
