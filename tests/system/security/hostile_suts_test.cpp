#include "support/memory_watch.h"
#include "support/raw_peer.h"
#include "support/trials.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <tether/link/codec.h>

/// A SUT that has the token and breaks the rules: the run ends with a reason that names it, and
/// nothing that it did becomes a result.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

// ---- What a SUT sends

link::Hello hello_for(const std::string& uav) {
  link::Hello hello;
  hello.sut = "hostile 1.0";
  hello.uav = uav;
  hello.clock = {computer::ClockKind::kScripted, 1.0, 2ms};
  hello.token = ExternalRun::token();
  return hello;
}

template <class Body>
link::Request request(std::uint64_t sequence, std::int64_t at_ns, const Body& body) {
  link::Request request;
  request.sequence = sequence;
  request.issued_at = from_ns<ExecTime>(at_ns);
  request.body = body;
  return request;
}
link::Request sleep_request(std::uint64_t sequence, std::int64_t at_ns, std::int64_t until_ns) {
  return request(sequence, at_ns, link::Sleep{from_ns<ExecTime>(until_ns)});
}
link::Request command(std::uint64_t sequence, std::int64_t at_ns) {
  return request(sequence, at_ns, link::SetVelocity{});
}
link::Annotation annotation(std::size_t bytes) {
  return {ExecTime{}, "step", "{\"x\": \"" + std::string(bytes, 'x') + "\"}"};
}

constexpr std::int64_t kMs = 1'000'000;

constexpr link::ReadSensor kCamera{.sensor = 0, .latest = true};

/// A second of correct flying: 100 requests, each with its reply. Returns the next sequence number.
/// The last reads the camera, so that the run has by then the memory that drawing takes.
std::uint64_t fly_correctly(RawPeer& sut) {
  std::uint64_t sequence = 1;
  for (; sequence <= 100; ++sequence) {
    const auto t = static_cast<std::int64_t>(sequence) * 10 * kMs;
    EXPECT_TRUE(sut.write(sequence < 100 ? sleep_request(sequence, t - 8 * kMs, t)
                                         : request(sequence, t, kCamera)));
    const auto reply = sut.read(20s);
    EXPECT_TRUE(reply && std::holds_alternative<link::Reply>(*reply));
  }
  return sequence;
}
constexpr std::int64_t kFlown = 1000 * kMs;

// ---- Each violation, and what the reason names

struct SutMisdeed {
  std::string name;
  /// `next`: the sequence number of the next request, which may be stamped kFlown.
  std::function<void(RawPeer&, std::uint64_t next)> act;
  std::string reason;  ///< part of the run's
  std::string end = "sut_lost";
  /// Its scripted clock does not advance between calls: the audit finds that, too.
  bool is_timeless = false;
};

void PrintTo(const SutMisdeed& misdeed, std::ostream* out) {
  *out << misdeed.name;
}

SutMisdeed sends(const std::string& name,
                 const std::function<link::Message(std::uint64_t)>& message,
                 const std::string& reason) {
  return {name, [=](RawPeer& sut, std::uint64_t next) { sut.write(message(next)); }, reason};
}

// One of each kind. The rules themselves: common/link/test/validate_test.cpp,
// host/flight/coordinator/test/sessions/validator_test.cpp.
const SutMisdeed kSutMisdeeds[] = {
    sends(
        "NoSuchSensor",
        [](auto next) { return request(next, kFlown, link::ReadSensor{.sensor = 99}); }, "99"),
    sends(
        "HugeAnnotation", [](auto) { return annotation(2u << 20); }, "1048576"),
    sends(
        "Reply",
        [](auto) {
          return link::Reply{1, ExecTime{}, std::nullopt};
        },
        ""),
    {"HelloAgain", [](RawPeer& sut, auto) { sut.write(hello_for("")); }, ""},
    {"FourGigabytes", [](RawPeer& sut, auto) { sut.write(std::string(4, '\xff')); }, "4294967295"},
    {"Garbage",
     [](RawPeer& sut, auto) { sut.write(std::string("\x20\0\0\0", 4) + std::string(32, 'x')); },
     ""},
    {"ImagesThatItDoesNotRead",
     [](RawPeer& sut, std::uint64_t next) {
       while (sut.write(request(next++, kFlown, kCamera))) std::this_thread::sleep_for(5ms);
     },
     "", "sut_lost", true},
    {"ClosedHalfWhileHeld",
     [](RawPeer& sut, std::uint64_t next) {
       sut.write(sleep_request(next, kFlown, 4 * kFlown));
       sut.shut(SHUT_WR);
     },
     ""},
    {"GoneInHalfAFinish",
     [](RawPeer& sut, std::uint64_t next) {
       const std::string frame = frame_of(request(next, kFlown, link::Finish{true, "done", "{}"}));
       sut.write(frame.substr(0, frame.size() / 2));
       sut.shut(SHUT_RDWR);
     },
     ""},
    {"GoneWhileHeld",
     [](RawPeer& sut, std::uint64_t next) {
       sut.write(sleep_request(next, kFlown, 4 * kFlown));
       sut.shut(SHUT_RDWR);
     },
     "ET 4.000000 s"},
    {"ClosedTheOtherHalf", [](RawPeer& sut, auto) { sut.shut(SHUT_RD); }, "2 s", "sut_hung"},
    {"AFrameThatNeverEnds",
     [](RawPeer& sut, std::uint64_t next) {
       const std::string frame = frame_of(command(next, kFlown));
       sut.write(frame.substr(0, frame.size() - 1));
     },
     "2 s", "sut_hung"},
    // Few enough that it is not their number that ends it.
    {"AnnotationsWithoutEnd",
     [](RawPeer& sut, auto) {
       const std::string note = frame_of(annotation(10));
       for (int i = 0; i < 40'000; ++i) sut.write(note);
       while (sut.write(note)) std::this_thread::sleep_for(1ms);
     },
     "2 s", "sut_hung"},
    {"CallsThatTakeNoTime",
     [](RawPeer& sut, std::uint64_t next) {
       const link::ReadSensor if_there{.sensor = 1, .only_if_available = true};
       while (sut.write(request(next++, kFlown, if_there)) && sut.read(20s)) {
       }
     },
     "10001", "sut_lost", true},
    {"ProgressWithoutEnd",
     [](RawPeer& sut, auto) {
       const std::string same = frame_of(link::Progress{from_ns<ExecTime>(kFlown)});
       while (sut.write(same)) {
       }
     },
     "2 s", "sut_hung"},
};

void join(RawPeer& sut, const std::string& uav = "") {
  sut.write(hello_for(uav));
  const auto welcome = sut.read(30s);
  EXPECT_TRUE(welcome && std::holds_alternative<link::Welcome>(*welcome));
}

class HostileSut : public testing::TestWithParam<SutMisdeed> {
 protected:
  TempFolder folder_;
};

TEST_P(HostileSut, EndsItsRunByName) {
  ExternalRun run(write_hover_scenario(folder_.path(), "good", {kScripted}), folder_ / "out");
  RawPeer sut(run.address());
  join(sut);
  const std::uint64_t next = fly_correctly(sut);

  const MemoryWatch memory(run.process().pid());
  const long flown_KiB = memory.most_KiB();
  GetParam().act(sut, next);
  const Output output = run.wait(40s);
  EXPECT_EQ(output.code, 3);
  EXPECT_FALSE(output.timed_out);
  if (kMemoryIsTethers) {
    EXPECT_LT(memory.most_KiB(), flown_KiB + kMostExtraMemory_KiB);
  }

  const auto result = read_result(folder_ / "out");
  EXPECT_EQ(result["outcome"], "failed");
  EXPECT_EQ(result["end"], GetParam().end);
  EXPECT_EQ(result["exit_code"], 3);
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr(GetParam().reason));
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("uav1"));
  // What had been flown before is in the record, and sound.
  EXPECT_GE(read_record(folder_ / "out").interactions.size(), 100u);
  EXPECT_EQ(audit_code(folder_ / "out"), GetParam().is_timeless ? 1 : 0);
}

INSTANTIATE_TEST_SUITE_P(Misdeeds, HostileSut, testing::ValuesIn(kSutMisdeeds),
                         [](const auto& misdeed) { return misdeed.param.name; });

// ---- That leave early

/// A SUT that closes its connection, in each way, as soon as it has sent its Finish, which is held
/// then for 3 s of ST.
class LeavingSut : public testing::TestWithParam<std::string> {};

TEST_P(LeavingSut, HasFinished) {
  const TempFolder folder;
  ExternalRun run(write_hover_scenario(folder.path(), "good", {kScripted}), folder / "out");
  std::optional<RawPeer> sut(std::in_place, run.address());
  join(*sut);
  sut->write(request(fly_correctly(*sut), 4 * kFlown, link::Finish{true, "done", "{}"}));
  if (GetParam() == "Half") {
    sut->shut(SHUT_WR);
    const auto confirmed = sut->read(30s);
    ASSERT_TRUE(confirmed && std::holds_alternative<link::Reply>(*confirmed));
    EXPECT_EQ(to_ns(std::get<link::Reply>(*confirmed).resume_at), 4 * kFlown);
  } else {
    if (GetParam() == "ByAReset") sut->reset_at_close();
    sut.reset();
  }
  EXPECT_EQ(run.wait(40s).code, 0);
  const auto result = read_result(folder / "out");
  EXPECT_EQ(result["end"], "finished");
  EXPECT_EQ(result["suts"][0]["outcome"], "done");
  EXPECT_EQ(result["sync"]["st_at_end_s"], 4.0);
  EXPECT_EQ(audit_code(folder / "out"), 0);
}

INSTANTIATE_TEST_SUITE_P(Closing, LeavingSut, testing::Values("Half", "Whole", "ByAReset"),
                         [](const auto& how) { return how.param; });

// ---- Beside a correct one

/// The reason names the SUT that ended the run.
TEST(HostileSutBesideAnother, EndsTheRunInItsOwnName) {
  const TempFolder folder;
  const std::string second =
      "[[uav]]\nname = \"uav2\"\nmodel = \"" TETHER_SOURCE_DIR
      "/data/models/hummingbird/model.sdf\"\nposition_m = [2.0, 0.0, 1.0]\n\n[sut]";
  ExternalRun run(
      write_hover_scenario(folder.path(), "fly_on",
                           {kScripted,
                            {"[sut]", second},
                            {"\"time_required\"", "\"time_required\"\nuav = \"uav1\""}}),
      folder / "out");
  const auto other = run.start_sut({bad_sut_program(), "fly_on"}, {{"TETHER_UAV", "uav1"}});
  RawPeer sut(run.address());
  join(sut, "uav2");
  const std::uint64_t next = fly_correctly(sut);
  sut.write(command(next + 7, kFlown));

  EXPECT_EQ(run.wait(20s).code, 3);
  const std::string reason = read_result(folder / "out")["reason"];
  EXPECT_THAT(reason, AllOf(HasSubstr("\"uav2\""), HasSubstr("108")));
  const Output ended = other->wait(10s);
  EXPECT_EQ(ended.code, 3);
  EXPECT_THAT(ended.err, HasSubstr("uav2"));
}

}  // namespace
}  // namespace tether::system_test
