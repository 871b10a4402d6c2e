#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/time.h>

/// What a run's record holds (DESIGN section 5): plain data, one struct per kind of message. All
/// times in a record are integer nanoseconds; a message's log time is the ST at which it was
/// written.
namespace tether::record {

inline constexpr int kSchemaVersion = 1;

/// One request of a SUT and its reply. Topic /interactions; log time = ST at release.
struct Interaction {
  std::string uav;
  std::uint64_t sequence = 0;
  std::string kind;                   ///< "sensor", "command", "sleep", "finish"
  std::string sensor;                 ///< of kind "sensor"
  std::uint64_t sample_index = 0;     ///< of kind "sensor"
  ExecTime request_at;                ///< t_req as charged
  ExecTime reply_at;                  ///< t_rep
  std::optional<SimTime> sampled_at;  ///< kind "sensor": instant that the timing model asked for
  std::optional<SimTime>
      sample_state_at;  ///< kind "sensor": step boundary whose state was measured (its floor)
  std::optional<SimTime> available_at;  ///< kind "sensor": sampled_at + delay
  std::optional<SimTime> effect_at;     ///< kind "command": first step boundary it acts on
  SimTime st_at_arrival;
  SimTime st_at_release;
  Duration lag{0};         ///< ε = request_at − st_at_arrival
  Duration grid_error{0};  ///< what the step grid moved: of the sample, the effect or the release
  bool stamped = true;     ///< request_at came from the SUT's side
  std::optional<std::string> violation;  ///< causality violation, named
  WallTime wall_at_arrival;              ///< host clock; differs from run to run
  WallTime wall_at_release;
  std::optional<Duration>
      previous_link_time;  ///< round trip of the previous interaction, less the time it was held
};

/// A command taking effect: written when the simulator was told. Topic /commands/<uav>; log time =
/// ST.
struct CommandEffect {
  std::string uav;
  std::uint64_t sequence = 0;
  SimTime applied_at;
  double vx_H_m_s = 0, vy_H_m_s = 0, vz_H_m_s = 0, yaw_rate_rad_s = 0;
};

/// Topic /ground_truth/<uav>.
struct GroundTruth {
  std::string uav;
  SimTime at;
  double p_WB_m[3] = {};
  double q_WB[4] = {1, 0, 0, 0};  ///< w x y z
  double v_WB_m_s[3] = {};
  double w_WB_B_rad_s[3] = {};
};

/// What the SUT had to say. Topic /task/<uav>; log time = ST when it arrived.
struct Annotation {
  std::string uav;
  ExecTime at;
  std::string topic;
  std::string json;  ///< one JSON object
};

/// Topic /images/<uav>/<sensor>: foxglove.CompressedImage (PNG).
struct Image {
  std::string uav;
  std::string sensor;
  SimTime at;
  std::uint64_t index = 0;
  std::vector<std::uint8_t> png;
};

/// What rests under every number: written first (metadata record "tether"), as names and values.
struct Anchor {
  std::string name;
  std::string shape;
  double size_m[3] = {};
  double p_WA_m[3] = {};
  double q_WA[4] = {1, 0, 0, 0};
};
struct SensorInfo {
  std::string uav;
  std::string name;
  std::string kind;  ///< "camera", "imu", "range"
  bool periodic = false;
  Duration period{0};
  Duration phase{0};
};
struct SutInfo {
  std::string uav;
  std::string sut;    ///< name and version it gave
  std::string clock;  ///< "wall", "cpu", "scripted", "unstamped"
  double cpu_factor = 1.0;
};
struct Header {
  int schema_version = kSchemaVersion;
  std::string tether_version;
  std::string scenario;
  std::string condition;
  std::string policy;  ///< "conservative_barrier" or "free_running"
  std::string simulator;
  std::string machine;
  std::uint64_t seed = 0;
  Duration step{0};
  Duration command_latency{0};
  double real_time_factor = 0.0;  ///< limit on ST per WT; 0: none
  std::vector<SutInfo> suts;
  std::vector<SensorInfo> sensors;
  std::vector<Anchor> anchors;
};

/// How the run ended: written last (metadata record "tether.end"). A record without it was cut
/// short.
struct Footer {
  std::string
      end;  ///< "finished", "time_limit", "sut_lost", "sut_hung", "simulator_lost", "interrupted"
  std::string reason;  ///< one line
  SimTime st_at_end;
  std::vector<ExecTime> et_at_end;  ///< per SUT, in the header's order
  Duration wall{0};
  std::uint64_t interactions = 0;
  std::uint64_t causality_violations = 0;
  Duration largest_lag{0};
  Duration largest_grid_error{0};
};

}  // namespace tether::record
