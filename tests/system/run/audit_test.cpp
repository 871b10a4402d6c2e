#include "support/trials.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tether/audit/audit.h>

/// Whatever of a real record the rest of it contradicts: each change of one field, or of one kind
/// of message, is found as a breach of its rule, and nothing is found in the record itself.
namespace tether::system_test {
namespace {

using record::Record;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

/// One field of one message is changed, or messages of one topic are removed.
struct Change {
  const char* what;
  int rule;
  std::function<void(Record&)> make;
};

/// The message in the middle of those that are wanted.
template <class Message>
Message& one_of(std::vector<record::Logged<Message>>& messages,
                const std::function<bool(const Message&)>& wanted = nullptr) {
  std::vector<Message*> found;
  for (auto& entry : messages)
    if (!wanted || wanted(entry.message)) found.push_back(&entry.message);
  if (found.empty()) throw std::logic_error("the record has no such message");
  return *found[found.size() / 2];
}

record::Interaction& call(Record& record, std::string_view kind) {
  return one_of<record::Interaction>(record.interactions,
                                     [&](const auto& m) { return m.kind == kind; });
}
record::RadioMessage& fate(Record& record, std::string_view outcome) {
  return one_of<record::RadioMessage>(record.radio,
                                      [&](const auto& m) { return m.outcome == outcome; });
}
record::Battery& battery(Record& record) {
  return one_of(record.batteries);
}
/// In free flight.
record::GroundTruth& truth(Record& record) {
  return one_of<record::GroundTruth>(record.ground_truth,
                                     [](const auto& m) { return m.clearance_m > 0.5; });
}
record::EnergyInfo& energy(Record& record) {
  return *record.header.suts[0].energy;
}

void expect_found(const Record& sound, const std::vector<Change>& changes) {
  const audit::Verdict verdict = audit::audit(sound);
  ASSERT_TRUE(verdict.passed()) << audit::to_text(verdict);
  for (const Change& change : changes) {
    Record record = sound;
    change.make(record);
    const audit::Verdict altered = audit::audit(record);
    EXPECT_TRUE(std::ranges::count(altered.findings, change.rule, &audit::Finding::rule) > 0)
        << change.what << ": " << audit::to_text(altered, 5);
  }
}

class AuditOfAFlight : public testing::Test {
 protected:
  Record fly(const std::string& mode, std::vector<Substitution> changes,
             const std::string& condition = "host") {
    changes.push_back(kScripted);
    changes.emplace_back("kind = \"time_required\"", "kind = \"time_required\"\nuav = \"uav1\"");
    const auto scenario = write_hover_scenario(folder_.path(), mode, changes);
    const Output output = run(
        tether({"run", scenario, "--condition", condition, "--quiet", "--out", folder_ / "out"}));
    EXPECT_TRUE(output.code == 0 || output.code == 1) << output.err;
    return read_record(folder_ / "out");
  }

  TempFolder folder_;
};

const Substitution kEnergy{"position_m = [0.0, 0.0, 1.0]",
                           "position_m = [0.0, 0.0, 1.0]\nenergy = \"" TETHER_SOURCE_DIR
                           "/data/energy/hummingbird.toml\""};
/// Two more UAVs.
Substitution two_more(const std::string& keys) {
  std::string uavs;
  for (const char* uav : {"uav2", "uav3"})
    uavs += "[[uav]]\nname = \"" + std::string(uav) +
            "\"\nmodel = \"" TETHER_SOURCE_DIR
            "/data/models/hummingbird/model.sdf\"\nposition_m = [0.0, " +
            std::string(uav == std::string("uav2") ? "3.0" : "-3.0") + ", 1.0]\n" + keys + "\n";
  return {"[sut]\n", uavs + "[sut]\n"};
}

// A serial SUT, whose UAV has a battery and lands on the floor.
TEST_F(AuditOfAFlight, FindsWhatContradictsTheRestOfTheRecord) {
  const std::vector<Change> changes = {
      {"all contacts removed", 0, [](Record& r) { r.contacts.clear(); }},
      {"all contacts removed, and their number", 0,
       [](Record& r) {
         r.contacts.clear();
         std::erase_if(r.footer->topics, [](const auto& t) { return t.topic == "/contacts/uav1"; });
       }},
      {"contacts not reported", 0, [](Record& r) { r.header.reports_contacts = false; }},
      {"time of a contact", 0, [](Record& r) { one_of(r.contacts).at -= milliseconds(100); }},
      {"speed of a contact", 0, [](Record& r) { one_of(r.contacts).speed_m_s += 10.0; }},
      {"last annotation removed", 0, [](Record& r) { r.annotations.pop_back(); }},
      {"numbers of messages removed", 0, [](Record& r) { r.footer->topics.clear(); }},
      {"all commands removed", 0, [](Record& r) { r.commands.clear(); }},
      {"all poses for 3D views removed", 0, [](Record& r) { r.unloaded.clear(); }},

      {"voltage", 0, [](Record& r) { battery(r).voltage_V += 0.01; }},
      {"current", 0, [](Record& r) { battery(r).current_A *= 1.05; }},
      {"charge", 0, [](Record& r) { battery(r).charge -= 0.001; }},
      {"energy of lift", 0, [](Record& r) { battery(r).lift_J += 1.0; }},
      {"energy of moving", 0, [](Record& r) { battery(r).moving_J += 1.0; }},
      {"energy of the idle computer", 0, [](Record& r) { battery(r).idle_J += 1.0; }},
      {"energy of computing", 0, [](Record& r) { battery(r).computing_J += 1.0; }},
      {"energy of sensors", 0, [](Record& r) { battery(r).sensors_J += 1.0; }},
      {"energy of the resistance", 0, [](Record& r) { battery(r).resistance_J += 1.0; }},
      {"energy of lift booked as moving", 0,
       [](Record& r) {
         battery(r).lift_J -= 1.0;
         battery(r).moving_J += 1.0;
       }},
      {"energy of computing booked as moving", 0,
       [](Record& r) {
         battery(r).moving_J += battery(r).computing_J;
         battery(r).computing_J = 0.0;
       }},
      {"time of the battery", 0, [](Record& r) { battery(r).at += milliseconds(1); }},
      {"capacity", 0, [](Record& r) { energy(r).capacity_C *= 1.01; }},
      {"resistance", 0, [](Record& r) { energy(r).resistance_ohm *= 1.1; }},
      {"initial charge", 0, [](Record& r) { energy(r).initial_charge -= 0.01; }},
      {"power of lift", 0, [](Record& r) { energy(r).lift_W += 1.0; }},
      {"power of a busy core", 0, [](Record& r) { energy(r).busy_core_W *= 0.5; }},
      {"model of the battery removed", 0, [](Record& r) { r.header.suts[0].energy.reset(); }},
      {"battery that was read", 1, [](Record& r) { call(r, "battery").battery->charge += 0.01; }},

      {"sign of a command", 2, [](Record& r) { one_of(r.commands).yaw_rate_rad_s *= -1.0; }},
      {"command", 2, [](Record& r) { one_of(r.commands).vx_H_m_s += 0.1; }},
      {"what was commanded", 2, [](Record& r) { call(r, "command").command->vz_H_m_s += 0.1; }},
      {"no velocity in a command", 0, [](Record& r) { call(r, "command").command.reset(); }},

      {"position", 0, [](Record& r) { truth(r).p_WB_m[0] += 0.02; }},
      {"velocity", 0, [](Record& r) { truth(r).v_WB_m_s[1] += 1.0; }},
      {"sign of a velocity", 0,
       [](Record& r) {
         auto& m = one_of<record::GroundTruth>(r.ground_truth, [](const auto& t) {
           return t.clearance_m > 0.3 && t.v_WB_m_s[2] < -0.6;
         });
         m.v_WB_m_s[2] *= -1.0;
       }},
      {"attitude", 0, [](Record& r) { std::swap(truth(r).q_WB[0], truth(r).q_WB[3]); }},
      {"rate of rotation", 0, [](Record& r) { truth(r).w_WB_B_rad_s[0] += 100.0; }},
      {"clearance", 0, [](Record& r) { *truth(r).clearance_m += 0.05; }},
      {"a clearance removed", 0, [](Record& r) { truth(r).clearance_m.reset(); }},
      {"least clearance", 0, [](Record& r) { r.footer->clearances[0].min_m += 0.01; }},
      {"time of the least clearance", 0,
       [](Record& r) { r.footer->clearances[0].at += milliseconds(20); }},
      {"least clearance removed", 0, [](Record& r) { r.footer->clearances.clear(); }},

      {"end: limit", 0, [](Record& r) { r.footer->end = "time_limit"; }},
      {"end: lost", 0, [](Record& r) { r.footer->end = "sut_lost"; }},
      {"end: interrupted", 0, [](Record& r) { r.footer->end = "interrupted"; }},
      {"end: battery", 0, [](Record& r) { r.footer->end = "battery_empty"; }},
      {"end: unknown", 0, [](Record& r) { r.footer->end = "well"; }},
      {"expelled", 0, [](Record& r) { r.footer->expelled = {"uav1"}; }},
      {"ST at the end", 0, [](Record& r) { r.footer->st_at_end += milliseconds(1); }},
      {"ET at the end", 5, [](Record& r) { r.footer->et_at_end[0] += nanoseconds(1); }},
      {"limit", 0,
       [](Record& r) {
         r.header.time_limit = milliseconds(1);
         r.footer->end = "sut_lost";
       }},

      {"scripted computing", 5,
       [](Record& r) { r.header.suts[0].clock.computing = milliseconds(3); }},
      {"a stage", 5,
       [](Record& r) {
         one_of<record::Interaction>(r.interactions,
                                     [](const auto& m) { return !m.stages.empty(); })
             .stages[0]
             .computing += nanoseconds(1);
       }},
      {"time of a request", 5, [](Record& r) { call(r, "sleep").request_at -= nanoseconds(1); }},
      {"end of a sleep", 7, [](Record& r) { *call(r, "sleep").sleep_until += nanoseconds(1); }},
      {"kind of a call", 0, [](Record& r) { call(r, "command").kind = record::kBattery; }},
      {"sensor of a reading", 0, [](Record& r) { call(r, "sensor").sensor = "sonar"; }},
      {"a shared board", 5, [](Record& r) { call(r, "sleep").computed = milliseconds(2); }},
      {"policy", 8, [](Record& r) { r.header.policy = record::kFreeRunning; }},
      {"step", 0, [](Record& r) { r.header.step *= 2; }},
      {"period of the ground truth", 0, [](Record& r) { r.header.ground_truth_period *= 2; }},
      {"latency of commands", 2,
       [](Record& r) { r.header.suts[0].command_latency += milliseconds(1); }},
      {"clock", 6, [](Record& r) { r.header.suts[0].clock.kind = computer::ClockKind::kCpu; }},
  };
  expect_found(fly("fly_down", {kEnergy}), changes);
}

// As if all of its SUTs had ended before.
TEST_F(AuditOfAFlight, FindsAnEndThatIsNotThatOfTheFlight) {
  const Record sound = fly("sleep_long", {{"time_limit_s = 5", "time_limit_s = 2"}});
  expect_found(sound, {{"finished", 0, [](Record& r) { r.footer->end = "finished"; }},
                       {"lost", 0, [](Record& r) { r.footer->end = "sut_lost"; }},
                       {"flooded", 0, [](Record& r) { r.footer->end = "flooded"; }},
                       {"limit", 0, [](Record& r) { r.header.time_limit += milliseconds(1); }}});
}

// Three UAVs that talk by a radio that loses a third, in bursts and alone.
TEST_F(AuditOfAFlight, FindsWhatContradictsARadioByDistribution) {
  const Substitution radio{
      "[[condition]]\nname = \"host\"",
      "[radio]\nmodel = \"distribution\"\ndelay_ms = 1\ndata_rate_bit_s = 1e6\n"
      "delay = { kind = \"empirical\", samples_ms = [0.5, 3, 9] }\nloss_probability = 0.2\n"
      "burst_begin_probability = 0.1\nburst_end_probability = 0.5\n\n"
      "[[condition]]\nname = \"host\""};
  const Record sound = fly("exchange", {two_more(""), radio});
  expect_found(
      sound,
      {{"delivered as dropped", 0, [](Record& r) { fate(r, "delivered").outcome = "dropped"; }},
       {"dropped as delivered", 0, [](Record& r) { fate(r, "dropped").outcome = "delivered"; }},
       {"later than any delay", 0, [](Record& r) { fate(r, "delivered").at += milliseconds(10); }},
       {"seed", 0, [](Record& r) { r.header.seed += 1; }},
       {"bursts", 0, [](Record& r) { r.header.radio.burst_begin_probability = 0.0; }}});
}

// Three UAVs that talk at once, over a radio that is barely good enough.
TEST_F(AuditOfAFlight, FindsWhatContradictsTheRadio) {
  const Substitution radio{"[[condition]]\nname = \"host\"",
                           "[radio]\nmodel = \"log_distance\"\ntx_power_dbm = -33.0\n"
                           "shadowing_db = 1.0\n\n[[condition]]\nname = \"host\""};
  const Record sound = fly("exchange", {two_more(""), radio});
  const std::vector<Change> changes = {
      {"all messages removed", 0, [](Record& r) { r.radio.clear(); }},
      {"a message removed", 0, [](Record& r) { r.radio.pop_back(); }},
      {"delivered as lost", 0, [](Record& r) { fate(r, "delivered").outcome = "noise"; }},
      {"delivered as collided", 0, [](Record& r) { fate(r, "delivered").outcome = "collision"; }},
      {"delivered as refused", 0, [](Record& r) { fate(r, "delivered").outcome = "inbox_full"; }},
      {"delivered as queued", 0, [](Record& r) { fate(r, "delivered").outcome = "queue_full"; }},
      {"lost as delivered", 0, [](Record& r) { fate(r, "noise").outcome = "delivered"; }},
      {"lost as waiting", 0, [](Record& r) { fate(r, "noise").outcome = "waiting"; }},
      {"size", 0, [](Record& r) { fate(r, "noise").bytes += 1; }},
      {"time of sending", 1, [](Record& r) { fate(r, "noise").sent_at -= nanoseconds(1); }},
      {"begin of the transmission", 0,
       [](Record& r) { *fate(r, "noise").began_at += nanoseconds(1); }},
      {"time of a loss", 0, [](Record& r) { fate(r, "noise").at += nanoseconds(1); }},
      {"time of an arrival", 0, [](Record& r) { fate(r, "delivered").at += nanoseconds(1); }},
      {"distance", 0, [](Record& r) { *fate(r, "delivered").distance_m += 0.05; }},
      {"walls", 0, [](Record& r) { *fate(r, "delivered").walls += 1; }},
      {"signal", 0, [](Record& r) { *fate(r, "noise").snr_db += 3.0; }},
      {"no distance", 0, [](Record& r) { fate(r, "delivered").distance_m.reset(); }},
      {"receiver", 0, [](Record& r) { fate(r, "noise").to = "uav9"; }},
      {"seed", 0, [](Record& r) { r.header.seed += 1; }},
      {"power", 0, [](Record& r) { r.header.radio.tx_power_dbm += 1.0; }},
      {"exponent", 0, [](Record& r) { r.header.radio.exponent += 0.1; }},
      {"loss at 1 m", 0, [](Record& r) { r.header.radio.reference_loss_db += 0.1; }},
      {"shadowing", 0, [](Record& r) { r.header.radio.shadowing_db = 0.0; }},
      {"noise figure", 0, [](Record& r) { r.header.radio.noise_figure_db += 0.1; }},
      {"bandwidth", 0, [](Record& r) { r.header.radio.bandwidth_hz *= 2.0; }},
      {"data rate", 0, [](Record& r) { r.header.radio.data_rate_bit_s *= 1.01; }},
      {"preamble", 0, [](Record& r) { r.header.radio.preamble += nanoseconds(1); }},
      {"header", 0, [](Record& r) { r.header.radio.header_bytes += 1; }},
      {"settings removed", 0, [](Record& r) { r.header.radio.inbox_messages = 0; }},
      {"model", 0, [](Record& r) { r.header.radio.model = "ideal"; }},
      {"access", 0, [](Record& r) { r.header.radio.access = "tdma"; }},
      {"inbox", 0, [](Record& r) { r.header.radio.inbox_messages = 1; }},
      {"what was received", 1,
       [](Record& r) {
         one_of<record::Interaction>(r.interactions, [](const auto& m) {
           return !!m.received;
         }).received->sequence += 1;
       }},
      {"position", 0, [](Record& r) { one_of(r.ground_truth).p_WB_m[1] += 0.05; }},
  };
  expect_found(sound, changes);
}

// Two of three programs share a pinned core.
TEST_F(AuditOfAFlight, FindsWhatContradictsASharedBoard) {
  const Substitution board{
      "[[uav]]\n",
      "[[target]]\nname = \"board\"\nclock = \"scripted\"\n"
      "computing_ms = 2\ncores = 2\n\n[[uav]]\ntarget = \"board\"\npinned_core = 0\n"};
  const auto pinned = two_more("target = \"board\"\npinned_core = 0");
  const Substitution condition{
      "name = \"slow\"\npolicy = \"conservative_barrier\"\nclock = \"cpu\"\ncpu_factor = 10.0",
      "name = \"one board\"\npolicy = \"conservative_barrier\""};
  const Record sound = fly("fly_down", {pinned, board, condition}, "one board");
  const std::vector<Change> changes = {
      {"boards removed", 0, [](Record& r) { r.header.boards.clear(); }},
      {"a board that nobody uses", 0,
       [](Record& r) {
         r.header.boards.push_back({"spare", 1});
       }},
      {"a SUT's board removed", 5, [](Record& r) { r.header.suts[0].board.clear(); }},
      {"a SUT's core", 5, [](Record& r) { r.header.suts[0].pinned_core = 1; }},
      {"what a SUT computed", 5, [](Record& r) { *call(r, "sleep").computed += nanoseconds(1); }},
      {"no computed time", 5, [](Record& r) { call(r, "sleep").computed.reset(); }},
      {"cores", 5, [](Record& r) { r.header.suts[0].pinned_core.reset(); }},
  };
  expect_found(sound, changes);
}

}  // namespace
}  // namespace tether::system_test
