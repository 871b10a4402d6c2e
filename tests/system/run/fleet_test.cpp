#include "support/trials.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/record/messages.h>

/// Several UAVs whose programs share a board, send each other messages, and wait: what a run shows
/// from outside.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

struct Sut {
  std::string calls;  // of script_sut
  std::string more = "target = \"board\"\n";
};

class Fleet : public testing::Test {
 protected:
  /// `head`: tables before the UAVs; `condition`: settings of the only one.
  void write(const std::string& head, const std::vector<Sut>& suts, const std::string& condition) {
    std::string text = "name = \"fleet\"\nworld = \"" + hover_world().string() +
                       "\"\ntime_limit_s = 5\nanchors = [\"blue_box\"]\n" + head;
    for (std::size_t i = 0; i < suts.size(); ++i)
      text += "[[uav]]\nname = \"uav" + std::to_string(i + 1) +
              "\"\nmodel = \"" TETHER_SOURCE_DIR
              "/data/models/hummingbird/model.sdf\"\n"
              "position_m = [0.0, " +
              std::to_string(2 * i) + ".0, 1.0]\n" + suts[i].more +
              "[uav.sut]\ncommand = [\"" SCRIPT_SUT_PROGRAM "\", " + suts[i].calls + "]\n";
    text += "[[condition]]\nname = \"only\"\n" + condition;
    write_text(folder_ / "fleet.toml", text);
  }
  Output fly(const std::string& out) {
    return run(tether({"run", folder_ / "fleet.toml", "--quiet", "--out", folder_ / out}), 60s);
  }
  /// The calls of a UAV, in order.
  std::vector<record::Interaction> calls_of(const std::string& uav, const std::string& out) {
    std::vector<record::Interaction> own;
    for (const auto& entry : read_record(folder_ / out).interactions)
      if (entry.message.uav == uav) own.push_back(entry.message);
    return own;
  }

  TempFolder folder_;
};

std::string board(int cores) {
  return "[[target]]\nname = \"board\"\nclock = \"scripted\"\ncomputing_ms = 1\ncores = " +
         std::to_string(cores) + "\n";
}
const std::string kBarrier = "policy = \"conservative_barrier\"\n";

TEST_F(Fleet, AMessageEndsAWaitOnASharedBoard) {
  write(board(1),
        {{R"("sleep:100", "send:uav2", "sleep:20", "finish")"},
         {R"("receive:3000", "turn:0.1", "sleep:20", "finish")"}},
        kBarrier);
  for (const char* out : {"first", "second"}) {
    const Output output = fly(out);
    EXPECT_EQ(output.code, 0) << output.err;
    EXPECT_EQ(audit_code(folder_ / out), 0);
    const auto sender = calls_of("uav1", out), receiver = calls_of("uav2", out);
    EXPECT_EQ(sender.at(1).request_at, ExecTime(103ms)) << "2 ms for the first ms, then alone";
    EXPECT_EQ(receiver.at(0).reply_at, ExecTime(103ms));
    EXPECT_EQ(receiver.at(1).request_at, ExecTime(105ms)) << "both compute";
  }
  EXPECT_EQ(read_text(folder_ / "first/record.mcap"), read_text(folder_ / "second/record.mcap"));
}

TEST_F(Fleet, AProgramCanBeAloneOnItsPinnedCore) {
  const std::string calls = R"("sleep:10", "sleep:10", "finish")";
  write(board(2), {{calls, "target = \"board\"\npinned_core = 0\n"}, {calls}, {calls}}, kBarrier);
  const Output output = fly("out");
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  EXPECT_EQ(calls_of("uav1", "out").at(2).request_at, ExecTime(23ms));
  EXPECT_EQ(calls_of("uav3", "out").at(2).request_at, ExecTime(26ms));
}

TEST_F(Fleet, ALostSutIsTheCauseWhateverIsInTransit) {
  write("", {{R"("send:", "send:", "send:", "finish")", ""}, {R"("sleep:1", "abort")", ""}},
        kBarrier + "clock = \"scripted\"\ncomputing_ms = 1.3\n");
  const Output output = fly("out");
  EXPECT_EQ(output.code, 3);
  const auto footer = read_record(folder_ / "out").footer;
  ASSERT_TRUE(footer);
  EXPECT_EQ(footer->end, "sut_lost");
  EXPECT_NE(footer->reason.find("\"uav2\""), std::string::npos) << footer->reason;
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
}

TEST_F(Fleet, SleepsAndWaitsForMessagesTakeSimulatedTimeInFreeRunning) {
  write("", {{R"("sleep:300", "receive:150", "finish")", ""}, {R"("sleep:10", "finish")", ""}},
        "policy = \"free_running\"\nreal_time_factor = 0.3\nclock = \"wall\"\n");
  const Output output = fly("out");
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  const auto calls = calls_of("uav1", "out");
  EXPECT_EQ(calls.at(0).st_at_release - calls[0].st_at_arrival, 300ms);
  EXPECT_EQ(calls.at(1).st_at_release - calls[1].st_at_arrival, 150ms);
  EXPECT_GE(output.wall, 1.5s);
}

}  // namespace
}  // namespace tether::system_test
