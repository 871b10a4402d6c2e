#pragma once

#include <cstddef>
#include <cstdint>

#include <tether/base/time.h>
#include <tether/uav/sensor_timing.h>

namespace tether::radio {

enum class Model : std::uint8_t {
  kIdeal,         ///< every message arrives after `delay`
  kLogDistance,   ///< path loss, noise, and one channel that all share
  kDistribution,  ///< delays and losses by distributions, wherever the UAVs are
};
enum class Access : std::uint8_t {
  kCsma,  ///< listen before talking
  kTdma,  ///< slots in turn
};

/// The radio of all UAVs ([radio] in scenarios; docs/guide/radio.md). The defaults of the channel
/// are those of IEEE 802.11a at 6 Mbit/s in the 5 GHz band.
struct Settings {
  Model model = Model::kIdeal;
  Duration delay{0};                 ///< from the call to the channel; ≥ 0
  std::size_t inbox_messages = 256;  ///< those that have arrived and were not received yet; ≥ 1

  // Of kDistribution: for each message at each receiver.
  uav::Delay drawn_delay{};       ///< added to `delay`
  double loss_probability = 0.0;  ///< outside of a burst; [0, 1]
  /// A burst of losses from one UAV to another begins, or ends, before a message: the model of
  /// E. N. Gilbert, "Capacity of a Burst-Noise Channel", Bell System Technical Journal 39, 1960.
  double burst_begin_probability = 0.0;  ///< [0, 1]
  double burst_end_probability = 1.0;    ///< (0, 1]

  // Of kLogDistance and kDistribution. Of kDistribution, 0: bytes take no time.
  double data_rate_bit_s = 6e6;  ///< > 0

  // Of kLogDistance.
  Access access = Access::kCsma;
  std::size_t queue_messages = 64;  ///< those that one UAV waits to transmit; ≥ 1
  Duration preamble{20'000};        ///< before the data; ≥ 0
  std::size_t header_bytes = 36;    ///< sent with each message
  double bandwidth_hz = 20e6;       ///< > 0
  double tx_power_dbm = 15.0;
  double noise_figure_db = 7.0;         ///< of the receivers; ≥ 0
  double reference_loss_db = 46.7;      ///< at 1 m, in free space; ≥ 0
  double exponent = 2.0;                ///< of the path loss; > 0
  double shadowing_db = 0.0;            ///< standard deviation; ≥ 0
  double wall_loss_db = 6.0;            ///< of each wall between two UAVs; ≥ 0
  double carrier_sense_dbm = -82.0;     ///< kCsma: above it, the channel is busy
  std::uint64_t contention_slots = 16;  ///< kCsma: slots of a random wait; ≥ 1
  /// > 0. kCsma: the unit of waits, and the time after which a transmission is heard. kTdma: what
  /// each UAV gets in turn.
  Duration slot{9'000};
};

}  // namespace tether::radio
