#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <tether/base_testing/scratch_folder.h>
#include <tether/record/reader.h>
#include <tether/record/writer.h>

/// Messages with every member set, and a small whole record of them.
namespace tether::record {

inline SimTime st_ms(std::int64_t ms) {
  return from_ns<SimTime>(ms * 1'000'000);
}
inline ExecTime et_ns(std::int64_t ns) {
  return from_ns<ExecTime>(ns);
}

inline Interaction sensor_interaction(std::uint64_t sequence = 1) {
  Interaction message;
  message.uav = "uav \"1\" é";
  message.sequence = sequence;
  message.kind = kSensor;
  message.sensor = "camera";
  message.sample_index = 18'446'744'073'709'551'615U;
  message.latest = true;
  message.request_at = et_ns(5'500'001);
  message.reply_at = et_ns(9'007'199'254'740'993);  // not a double
  message.sampled_at = from_ns<SimTime>(5'500'001);
  message.sample_state_at = st_ms(5);
  message.available_at = from_ns<SimTime>(37'500'001);
  message.st_at_arrival = st_ms(3);
  message.st_at_release = st_ms(37);
  message.lag = Duration(2'500'001);
  message.grid_error = Duration(500'001);
  message.stamped = false;
  message.violation = "sample from the future\n";
  message.stages = {{"detect", Duration(7), false}, {"decide", Duration(0), true}};
  message.wall_at_arrival = from_ns<WallTime>(123'456'789);
  message.wall_at_release = from_ns<WallTime>(223'456'789);
  message.previous_link_time = Duration(-5);
  return message;
}

inline Interaction interaction(std::string_view kind, std::uint64_t sequence) {
  Interaction message;
  message.uav = "a";
  message.sequence = sequence;
  message.kind = kind;
  return message;
}

inline Interaction command_interaction(std::uint64_t sequence = 2) {
  Interaction message = interaction(kCommand, sequence);
  message.request_at = message.reply_at = et_ns(40'000'001);
  message.effect_at = st_ms(41);
  message.st_at_release = st_ms(40);
  return message;
}

inline Interaction sleep_interaction(std::uint64_t sequence = 3) {
  Interaction message = interaction(kSleep, sequence);
  message.sleep_until = et_ns(50'000'000);
  return message;
}

/// A read that returned nothing.
inline Interaction vain_interaction(std::uint64_t sequence = 4) {
  Interaction message = interaction(kSensor, sequence);
  message.sensor = "camera";
  message.only_if_available = true;
  message.request_at = message.reply_at = et_ns(50'000'000);
  message.st_at_release = st_ms(50);
  return message;
}

inline Stop stop() {
  return {"a", et_ns(50'000'321), et_ns(50'000'000), from_ns<WallTime>(323'456'789)};
}

inline Interaction receive_interaction(std::uint64_t sequence = 5) {
  Interaction message = interaction(kReceive, sequence);
  message.receive_until = et_ns(60'000'000);
  message.received = {"b", 3, st_ms(40)};
  message.received_more = 2;
  return message;
}

inline Interaction battery_interaction(std::uint64_t sequence = 6) {
  Interaction message = interaction(kBattery, sequence);
  message.battery = {12.25, 6.5, 0.75};
  return message;
}

inline RadioMessage radio_message() {
  return {"a", 3, "b", 100, st_ms(39), st_ms(40), "collision", st_ms(39), 12.5, 2, -3.5};
}

inline Contact contact() {
  return {"a", st_ms(42), "room \"1\"", 1.0 / 3.0};
}

inline Battery battery() {
  return {"a", st_ms(40), 12.25, 6.5, 0.75, 1.0 / 3.0, -0.5, 2.0, 3.0, 4.0, 5.0};
}

inline CommandEffect command_effect(std::uint64_t sequence = 2) {
  return {"a", sequence, st_ms(41), 0.1, -0.0, 1e-300, 1.0 / 3.0};
}

inline GroundTruth ground_truth(std::int64_t ms = 40) {
  GroundTruth message;
  message.uav = "a";
  message.at = st_ms(ms);
  message.p_WB_m[0] = 1.0 / 3.0;
  message.p_WB_m[1] = -2.5e22;
  message.p_WB_m[2] = static_cast<double>(ms);
  message.q_WB[3] = 0.1;
  message.v_WB_m_s[1] = 5e-324;
  message.w_WB_B_rad_s[2] = -1.7976931348623157e308;
  message.clearance_m = 0.25;
  return message;
}

inline Annotation annotation() {
  return {"a", et_ns(39'999'999), "roi", R"({"z":[1,2.5,{"x":null}],"a":"ü"})"};
}

inline Image image() {
  return {"a", "camera", st_ms(33), 7, {0x89, 'P', 'N', 'G', 0, 255, 1}};
}

inline Header header() {
  Header header;
  header.tether_version = "0.1.0";
  header.scenario = "face_anchor";
  header.condition = "target, no sync";
  header.policy = kConservativeBarrier;
  header.simulator = "mujoco 2.2.2";
  header.machine = "test";
  header.seed = 18'446'744'073'709'551'615U;
  header.step = Duration(1'000'000);
  header.ground_truth_period = Duration(10'000'000);
  header.real_time_factor = 0.3;
  header.suts = {{"a",
                  "tether-sut 0.1.0",
                  {computer::ClockKind::kCpu, 6.5, Duration(8)},
                  Duration(2'000'000),
                  false,
                  4,
                  40.5,
                  computer::Clock{computer::ClockKind::kScripted, 7.5, Duration(9)},
                  "0a",
                  {{"argument 1", "--fast"}, {"library libx.so", "0c"}},
                  ReplayInfo{"board.timing", "exact", "2026-11-23T06:00:00Z", "pi", "0b"},
                  "",
                  std::nullopt,
                  "front"},
                 {"b", "other", {}, {}, true}};
  header.sensors = {
      {"a", "camera", "camera", true, Duration(33'333'333), Duration(5), Duration(7), Duration(8)},
      {"a", "range", "range", false, {}, {}}};
  header.sensors[0].camera = CameraInfo{{0.1, 0.2, -0.3},
                                        {0.5, 0.5, -0.5, 0.5},
                                        640,
                                        480,
                                        381.5,
                                        382.5,
                                        319.5,
                                        239.25,
                                        0.1,
                                        -0.2,
                                        0.3,
                                        -0.4,
                                        0.5};
  header.anchors = {{"box", "box", {0.4, 0.5, 0.6}, {8, 0, 1.5}, {0.5, 0.5, -0.5, 0.5}}};
  header.target = TargetInfo{
      "my board", "ssh://pi@board", {{"governor", "ondemand"}, {"throttled", "0x50005"}}};
  header.reports_contacts = true;
  header.emulator = {"qemu-x86_64", "Nehalem", {{"integer", 0.125}, {"load", 0.5}}};
  return header;
}

inline Footer footer() {
  Footer footer;
  footer.end = "finished";
  footer.reason = "goal reached";
  footer.st_at_end = st_ms(50);
  footer.et_at_end = {et_ns(50'000'000), et_ns(-1)};
  footer.wall = Duration(77);
  footer.interactions = 4;
  footer.causality_violations = 1;
  footer.largest_lag = Duration(2'500'001);
  footer.largest_grid_error = Duration(500'001);
  footer.stops = 1;
  footer.largest_overshoot = Duration(321);
  footer.clearances = {{"a", 0.25, st_ms(40), "room"}, {"b", 0.0, st_ms(0), "floor"}};
  footer.expelled = {"b"};
  footer.computing = {"a"};
  footer.target_after = {{"temperature_mc", "82500"}};
  return footer;
}

/// A file that is deleted after the test.
class TemporaryFile {
 public:
  const std::filesystem::path& path() const { return path_; }
  std::string bytes() const {
    std::ifstream stream(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }
  // In place: a file system may flush a file that was truncated to be written anew, which takes
  // long.
  void set_bytes(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::app);
    std::fstream(path_, std::ios::binary | std::ios::in | std::ios::out)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    std::filesystem::resize_file(path_, bytes.size());
  }

 private:
  ScratchFolder folder_;
  std::filesystem::path path_ = folder_.path("record.mcap");
};

/// One message of each kind but the footer.
inline void write_messages(Recorder& recorder) {
  recorder.write(header());
  recorder.write(st_ms(37), sensor_interaction());
  recorder.write(st_ms(38), annotation());
  recorder.write(st_ms(40), command_interaction());
  recorder.write(st_ms(40), ground_truth());
  recorder.write(st_ms(41), command_effect());
  recorder.write(st_ms(41), image());
  recorder.write(st_ms(50), contact());
  recorder.write(st_ms(50), sleep_interaction());
  recorder.write(st_ms(50), stop());
  recorder.write(st_ms(50), vain_interaction());
}

inline void write_whole_record(const std::filesystem::path& file) {
  const auto recorder = make_mcap_recorder(file);
  write_messages(*recorder);
  recorder->write(footer());
}

}  // namespace tether::record
