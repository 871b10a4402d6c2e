#include "support/still_world.h"
#include "support/trials.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <tether/link/socket.h>
#include <tether/sim_protocol/codec.h>

/// A simulator outside that breaks the protocol: its run ends with a reason in bounded time, and
/// nothing that it sent becomes a result.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
namespace protocol = sim::protocol;

// ---- A simulator that may send anything

constexpr SimTime kFailsAt = from_ns<SimTime>(500'000'000);

/// The host's connection, as seen from the simulator.
class Host {
 public:
  explicit Host(link::Descriptor socket)
      : socket_(std::move(socket), "the host", protocol::kMaxFrameBytes) {}

  std::optional<protocol::Request> receive() {
    const auto frame = socket_.receive();
    if (!frame) return std::nullopt;
    return protocol::decode_request(*frame).value();
  }
  /// Whatever is in it. False: the host is gone.
  bool send(const protocol::Reply& reply) { return socket_.send(encoder_.encode(reply)).ok(); }
  bool send(const std::string& bytes) const {
    return ::send(socket_.descriptor(), bytes.data(), bytes.size(), MSG_NOSIGNAL) > 0;
  }
  std::string frame_of(const protocol::Reply& reply) {
    const link::FramePieces pieces = encoder_.encode(reply);
    std::string bytes;
    for (const auto piece : {pieces.head, pieces.image, pieces.tail})
      bytes.append(reinterpret_cast<const char*>(piece.data()), piece.size());
    return bytes;
  }
  void shut(int how) const { ::shutdown(socket_.descriptor(), how); }
  void wait_until_gone() {
    while (socket_.receive()) {
    }
  }

 private:
  link::FrameSocket socket_;
  protocol::Encoder encoder_;
};

/// What is done in the place of this answer.
using SimulatorAct = std::function<void(Host&, protocol::Reply)>;

/// Serves one host; its answer to Open, or to the Advance up to kFailsAt, is the act.
class HostileSimulator {
 public:
  HostileSimulator(bool at_once, SimulatorAct act)
      : listener_(link::listen_on_tcp({"127.0.0.1", 0}).value()),
        thread_([this, at_once, act = std::move(act)] { serve(at_once, act); }) {}
  ~HostileSimulator() {
    ::shutdown(listener_.get(), SHUT_RDWR);
    thread_.join();
  }
  std::string address() const {
    return "tcp://127.0.0.1:" + std::to_string(link::local_address(listener_.get()).port);
  }

 private:
  void serve(bool at_once, const SimulatorAct& act) const {
    link::Descriptor socket(::accept(listener_.get(), nullptr, nullptr));
    if (!socket.is_open()) return;
    Host host(std::move(socket));
    StillWorld world;
    while (const auto request = host.receive()) {
      const auto* advance = std::get_if<protocol::Advance>(&*request);
      const protocol::Reply reply = world.answer(*request);
      if (at_once || (advance != nullptr && advance->to >= kFailsAt)) {
        act(host, reply);
        return host.wait_until_gone();
      }
      host.send(reply);
    }
  }

  link::Descriptor listener_;
  std::thread thread_;
};

// ---- Its misdeeds

struct Misdeed {
  std::string name;
  SimulatorAct act;
  std::string reason;  ///< part of the run's
};

/// The answer with another state.
Misdeed spoils(const std::string& name, const std::function<void(protocol::State&)>& spoil,
               const std::string& reason) {
  return {name,
          [=](Host& host, protocol::Reply reply) {
            auto* opened = std::get_if<protocol::Opened>(&reply);
            spoil(opened ? opened->state : std::get<protocol::State>(reply));
            host.send(reply);
          },
          reason};
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const std::string kSilent = "2 s";  // hang_limit_s of the scenario

const Misdeed kMisdeeds[] = {
    {"FourGigabytes", [](Host& host, auto) { host.send(std::string(4, '\xff')); }, "4294967295"},
    {"Nothing", [](Host&, auto) {}, kSilent},
    {"Garbage",
     [](Host& host, auto) { host.send(std::string("\x20\0\0\0", 4) + std::string(32, 'x')); }, ""},
    {"GarbageWithoutEnd",
     [](Host& host, auto) {
       while (host.send(std::string(10'000, '\x01'))) {
       }
     },
     ""},
    {"HalfAFrame",
     [](Host& host, const protocol::Reply& reply) {
       const std::string frame = host.frame_of(reply);
       host.send(frame.substr(0, frame.size() / 2));
     },
     kSilent},
    {"HalfAFrameAndTheEnd",
     [](Host& host, const protocol::Reply& reply) {
       const std::string frame = host.frame_of(reply);
       host.send(frame.substr(0, frame.size() / 2));
       host.shut(SHUT_WR);
     },
     ""},
    {"AByteNowAndThen",
     [](Host& host, const protocol::Reply& reply) {
       for (const char byte : host.frame_of(reply)) {
         if (!host.send(std::string(1, byte))) return;
         std::this_thread::sleep_for(100ms);
       }
     },
     kSilent},
    {"AnotherAnswer",
     [](Host& host, auto) { host.send(protocol::Reply(protocol::Distances{{1.0}})); }, "Distances"},
    spoils(
        "NoNumber", [](auto& state) { state.bodies[0].p_WB.x = kNan; }, "State.bodies"),
    spoils(
        "LargestTime", [](auto& state) { state.now = SimTime::max(); }, "State.now"),
};

struct Case {
  Misdeed misdeed;
  bool at_once = false;  ///< in the place of its first answer
};

void PrintTo(const Case& test, std::ostream* out) {
  *out << test.misdeed.name << (test.at_once ? "AtOnce" : "InFlight");
}

/// A simulator may take a minute to open a world, so that silence then is another test's
/// (faults_simulator).
std::vector<Case> cases() {
  std::vector<Case> list;
  for (const Misdeed& misdeed : kMisdeeds) {
    list.push_back({misdeed, false});
    if (misdeed.reason != kSilent) list.push_back({misdeed, true});
  }
  return list;
}

class HostileSimulatorTest : public testing::TestWithParam<Case> {};

TEST_P(HostileSimulatorTest, EndsItsRunByName) {
  const auto& [misdeed, at_once] = GetParam();
  const TempFolder folder;
  const HostileSimulator simulator(at_once, misdeed.act);
  const Output output = run(tether({"run", write_hover_scenario(folder.path(), "fly_on"),
                                    "--simulator", simulator.address(), "--out", folder / "out"}),
                            30s);
  EXPECT_FALSE(output.timed_out);
  EXPECT_EQ(output.code, 3);
  const auto result = read_result(folder / "out");
  const std::string reason = result["reason"];
  EXPECT_EQ(result["outcome"], "failed");
  EXPECT_EQ(result["end"], at_once ? "setup_failed" : "simulator_lost");
  EXPECT_THAT(reason, HasSubstr(misdeed.reason));
  EXPECT_THAT(reason, HasSubstr(at_once ? "" : "a stand-in"));
  EXPECT_THAT(output.err, HasSubstr("tether: " + reason));
  if (at_once) return;
  EXPECT_EQ(read_record(folder / "out").damage, "");
  EXPECT_EQ(audit_code(folder / "out"), 0);
}

INSTANTIATE_TEST_SUITE_P(Misdeeds, HostileSimulatorTest, testing::ValuesIn(cases()),
                         [](const auto& test) { return testing::PrintToString(test.param); });

}  // namespace
}  // namespace tether::system_test
