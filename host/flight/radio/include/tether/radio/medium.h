#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/radio/settings.h>

/// What arrives of a signal, and what can be read of it. Pure functions.
namespace tether::radio {

/// What lies between two UAVs.
struct Link {
  double distance_m = 0.0;
  int walls = 0;  ///< on the straight line between them
};

/// Path loss [dB]: the log-distance model, L0 + 10 n log10(d / 1 m) + X + walls × loss of a wall
/// (T. S. Rappaport, "Wireless Communications: Principles and Practice", 2nd ed. 2002, section 4.9;
/// walls as in A. Motley and J. Keenan, "Personal communication radio coverage in buildings at 900
/// MHz and 1700 MHz", Electronics Letters 24, 1988). `shadowing_db` is X. Below 1 m the loss is
/// that at 1 m.
double path_loss_db(const Settings& settings, const Link& link, double shadowing_db);

/// Thermal noise in the bandwidth at 290 K, and the receiver's [dBm]: −174 dBm/Hz + 10 log10(B) +
/// NF (Rappaport, section 4.3).
double noise_dbm(const Settings& settings);

/// Bit error rate of coherent BPSK, ½ erfc(√(Eb/N0)), with Eb/N0 = SNR · B / R (J. G. Proakis,
/// "Digital Communications", 4th ed. 2001, equation 5.2-5).
double bit_error_rate(const Settings& settings, double snr_db);

/// Probability that a message of so many bytes cannot be read: a bit of it or of its header is
/// wrong, 1 − (1 − BER)^bits.
double loss_probability(const Settings& settings, double snr_db, std::size_t bytes);

/// Preamble, and (bytes + header) × 8 / data rate, rounded up to whole nanoseconds.
Duration air_time(const Settings& settings, std::size_t bytes);

/// The least time between the sending of a message and its arrival.
Duration least_delay(const Settings& settings);

/// Sum of powers.
double sum_dbm(double a_dbm, double b_dbm);

struct Message {
  std::size_t from = 0;
  std::optional<std::size_t> to{};  ///< none: all others
  std::uint64_t sequence = 0;       ///< greater than that of the sender's earlier messages
  SimTime sent_at;
  /// Shared, because a message to all is in the inbox of several UAVs.
  std::shared_ptr<const std::vector<std::uint8_t>> bytes;
};

enum class Outcome : std::uint8_t {
  kDelivered,
  kNoise,       ///< the signal was too weak
  kCollision,   ///< another transmission was too strong
  kHalfDuplex,  ///< the receiver transmitted meanwhile
  kQueueFull,   ///< the sender had too many waiting
  kTooLong,     ///< its air time is longer than a slot
  kInboxFull,   ///< the receiver had too many waiting; decided by the caller
  kWaiting,     ///< not known at the end of the run
  kDropped,     ///< lost by the distribution
};
std::string_view name(Outcome outcome);

/// What became of a message at one of its receivers.
struct Arrival {
  Message message;
  std::size_t to = 0;
  Outcome outcome = Outcome::kDelivered;
  std::optional<SimTime> began_at{};  ///< of the transmission
  SimTime at;                         ///< of its arrival, or of its loss
  std::optional<Link> link{};         ///< none: ideal, or it was not transmitted
  std::optional<double> snr_db{};     ///< with interference
};

/// The channel that all UAVs share: a simulation by events in the order of (time, UAV), whose draws
/// are keyed by the seed. Which messages arrive, and when, is a function of the settings, the seed,
/// the messages and the links.
///
/// kCsma is non-persistent carrier sense (L. Kleinrock and F. A. Tobagi, "Packet Switching in Radio
/// Channels: Part I", IEEE Transactions on Communications 23, 1975): a UAV waits for some of
/// `contention_slots`, drawn; if it hears another transmission then, it waits for its end and draws
/// again. Nothing is acknowledged or repeated, as in broadcasts of IEEE 802.11.
/// kTdma: UAV i of n transmits in slots i, n + i, 2n + i, …
///
/// Not thread-safe.
class Medium {
 public:
  /// `uavs`: their names, which key the draws.
  Medium(const Settings& settings, std::uint64_t seed, std::vector<std::string> uavs);

  struct Instant {
    SimTime at;
    std::size_t uav = 0;
    friend auto operator<=>(const Instant&, const Instant&) = default;
  };

  /// @pre not before an event that was handled: (sent_at, from) ≥ its (at, uav).
  void send(const Message& message);
  /// The next event: nothing happens before, unless a message is sent. None: nothing is in transit.
  std::optional<Instant> next() const;
  /// What lies between two UAVs now.
  using LinkOf = std::function<Link(std::size_t from, std::size_t to)>;
  /// Handles the next event; appends what has arrived or was lost by it. @pre next()
  void handle_next(const LinkOf& link_of, std::vector<Arrival>& out);
  /// The messages that are still in transit, at each of their receivers, in the order of senders:
  /// `at` is `now`, or when they were sent or are being transmitted if that is later.
  std::vector<Arrival> in_transit(SimTime now) const;

 private:
  enum class Kind : std::uint8_t { kSend, kAttempt, kEnd };
  struct Event {
    Instant instant;
    std::uint64_t number = 0;  // in the order of creation
    Kind kind = Kind::kSend;
    Message message{};                      // of kSend, and of kEnd if there is no channel
    Outcome outcome = Outcome::kDelivered;  // of kEnd by distribution

    bool operator>(const Event& other) const {
      return std::pair(instant, number) > std::pair(other.instant, other.number);
    }
  };
  struct Transmission {
    std::size_t from = 0;
    SimTime began_at;
    SimTime ends_at;
  };
  struct Station {
    std::deque<Message> queue;                 // the first is being transmitted, or is the next
    std::optional<Transmission> transmission;  // under way
    std::vector<std::size_t> disturbed_by;     // UAVs that transmitted meanwhile
    std::uint64_t waits = 0;                   // drawn so far
  };

  void schedule(SimTime at, std::size_t uav, Kind kind, Message message = {},
                Outcome outcome = Outcome::kDelivered);
  void draw_fates(const Message& message);
  bool is_dropped(std::size_t from, std::size_t to, std::uint64_t sequence);
  void accept(Message message, std::vector<Arrival>& out);
  void plan(std::size_t uav, SimTime from, std::vector<Arrival>& out);
  void attempt(std::size_t uav, SimTime now, const LinkOf& link_of);
  void begin(std::size_t uav, SimTime now);
  void finish(std::size_t uav, SimTime now, const LinkOf& link_of, std::vector<Arrival>& out);
  Arrival receive(const Station& sender, std::size_t to, const LinkOf& link_of) const;
  double power_dbm(std::size_t from, std::size_t to, const Link& link) const;
  Duration draw_wait(std::size_t uav);
  SimTime next_slot(std::size_t uav, SimTime from, Duration air) const;
  /// Calls `use` for each receiver of the message.
  template <class Use>
  void for_receivers(const Message& message, Use use) const;

  Settings settings_;
  std::uint64_t seed_;
  std::vector<std::string> uavs_;
  std::vector<Station> stations_;
  std::map<std::pair<std::size_t, std::size_t>, bool> bursts_;  // from, to: one is under way
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::uint64_t events_made_ = 0;
};

}  // namespace tether::radio
