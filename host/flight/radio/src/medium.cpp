// A queue of events in the order of (time, UAV): `accept` queues a message at its sender, `plan`
// and `attempt` decide when it may be transmitted, `begin` starts the transmission, and `receive`
// decides at each receiver what became of it. Every draw has a key, so none depends on the others.

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <tether/base/random.h>
#include <tether/base/text.h>
#include <tether/radio/medium.h>

namespace tether::radio {

std::string_view name(Outcome outcome) {
  return enum_name(outcome, {"delivered", "noise", "collision", "half_duplex", "queue_full",
                             "too_long", "inbox_full", "waiting", "dropped"});
}

Medium::Medium(const Settings& settings, std::uint64_t seed, std::vector<std::string> uavs)
    : settings_(settings), seed_(seed), uavs_(std::move(uavs)), stations_(uavs_.size()) {}

template <class Use>
void Medium::for_receivers(const Message& message, Use use) const {
  for (std::size_t uav = 0; uav < uavs_.size(); ++uav)
    if (uav != message.from && (!message.to || *message.to == uav)) use(uav);
}

void Medium::schedule(SimTime at, std::size_t uav, Kind kind, Message message, Outcome outcome) {
  events_.push({{at, uav}, events_made_++, kind, std::move(message), outcome});
}

void Medium::send(const Message& message) {
  schedule(message.sent_at, message.from, Kind::kSend, message);
}

std::optional<Medium::Instant> Medium::next() const {
  if (events_.empty()) return std::nullopt;
  return events_.top().instant;
}

void Medium::handle_next(const LinkOf& link_of, std::vector<Arrival>& out) {
  Event event = events_.top();
  events_.pop();
  const SimTime now = event.instant.at;
  const std::size_t uav = event.instant.uav;
  if (event.kind == Kind::kAttempt) return attempt(uav, now, link_of);
  if (settings_.model == Model::kLogDistance) {
    if (event.kind == Kind::kSend) return accept(std::move(event.message), out);
    return finish(uav, now, link_of, out);
  }
  if (event.kind == Kind::kSend && settings_.model == Model::kDistribution)
    return draw_fates(event.message);
  if (event.kind == Kind::kSend && settings_.delay > Duration(0))
    return schedule(now + settings_.delay, uav, Kind::kEnd, std::move(event.message));
  for_receivers(event.message, [&](std::size_t to) {
    out.push_back({.message = event.message, .to = to, .outcome = event.outcome, .at = now});
  });
}

// --- by distribution ----------------------------------------------------------------------------

// Each receiver has an event of its own. A message that is dropped is so when it would arrive.
void Medium::draw_fates(const Message& message) {
  const double bits = 8.0 * static_cast<double>(message.bytes->size());
  const double rate = settings_.data_rate_bit_s;
  const Duration data(rate > 0.0 ? static_cast<std::int64_t>(std::ceil(bits / rate * 1e9)) : 0);
  for_receivers(message, [&](std::size_t to) {
    const Duration drawn =
        uav::draw(settings_.drawn_delay,
                  {.seed = seed_,
                   .stream = random_stream(uavs_[message.from], uavs_[to], "radio delay"),
                   .index = message.sequence});
    Message copy = message;
    copy.to = to;
    const bool dropped = is_dropped(message.from, to, message.sequence);
    schedule(message.sent_at + settings_.delay + drawn + data, message.from, Kind::kEnd,
             std::move(copy), dropped ? Outcome::kDropped : Outcome::kDelivered);
  });
}

bool Medium::is_dropped(std::size_t from, std::size_t to, std::uint64_t sequence) {
  const auto draw = [&](const char* quantity) {
    return KeyedRandom({.seed = seed_,
                        .stream = random_stream(uavs_[from], uavs_[to], quantity),
                        .index = sequence})
        .uniform();
  };
  bool& is_burst = bursts_[{from, to}];
  const double change =
      is_burst ? settings_.burst_end_probability : settings_.burst_begin_probability;
  if (draw("radio burst") < change) is_burst = !is_burst;
  return is_burst || draw("radio loss") < settings_.loss_probability;
}

// --- the sender ---------------------------------------------------------------------------------

void Medium::accept(Message message, std::vector<Arrival>& out) {
  Station& station = stations_[message.from];
  if (station.queue.size() >= settings_.queue_messages) {
    for_receivers(message, [&](std::size_t to) {
      out.push_back(
          {.message = message, .to = to, .outcome = Outcome::kQueueFull, .at = message.sent_at});
    });
    return;
  }
  const std::size_t uav = message.from;
  const SimTime ready = message.sent_at + settings_.delay;
  station.queue.push_back(std::move(message));
  if (station.queue.size() == 1) plan(uav, ready, out);
}

// When the first message of the queue may be transmitted, from `from` on.
void Medium::plan(std::size_t uav, SimTime from, std::vector<Arrival>& out) {
  std::deque<Message>& queue = stations_[uav].queue;
  if (settings_.access == Access::kTdma) {
    while (!queue.empty() && air_time(settings_, queue.front().bytes->size()) > settings_.slot) {
      const Message message = std::move(queue.front());
      queue.pop_front();
      for_receivers(message, [&](std::size_t to) {
        out.push_back({.message = message, .to = to, .outcome = Outcome::kTooLong, .at = from});
      });
    }
  }
  if (queue.empty()) return;
  const SimTime ready = std::max(from, queue.front().sent_at + settings_.delay);
  const SimTime at = settings_.access == Access::kTdma
                         ? next_slot(uav, ready, air_time(settings_, queue.front().bytes->size()))
                         : ready + draw_wait(uav);
  schedule(at, uav, Kind::kAttempt);
}

Duration Medium::draw_wait(std::size_t uav) {
  KeyedRandom random({.seed = seed_,
                      .stream = random_stream(uavs_[uav], "radio", "wait"),
                      .index = stations_[uav].waits++});
  const auto slots =
      static_cast<std::int64_t>(random.uniform() * static_cast<double>(settings_.contention_slots));
  return slots * settings_.slot;
}

// The first instant from `from` on at which so much of an own slot is left.
SimTime Medium::next_slot(std::size_t uav, SimTime from, Duration air) const {
  const Duration round = static_cast<std::int64_t>(uavs_.size()) * settings_.slot;
  const Duration own = static_cast<std::int64_t>(uav) * settings_.slot;
  const std::int64_t rounds = from.time_since_epoch() / round;
  for (SimTime begin = SimTime(rounds * round + own);; begin += round) {
    const SimTime at = std::max(from, begin);
    if (at + air <= begin + settings_.slot) return at;
  }
}

void Medium::attempt(std::size_t uav, SimTime now, const LinkOf& link_of) {
  std::optional<SimTime> busy_until;
  if (settings_.access == Access::kCsma) {
    for (const Station& other : stations_) {
      if (!other.transmission || other.transmission->ends_at <= now) continue;
      const Transmission& heard = *other.transmission;
      if (now - heard.began_at < settings_.slot) continue;
      if (power_dbm(heard.from, uav, link_of(heard.from, uav)) >= settings_.carrier_sense_dbm)
        busy_until = std::max(busy_until.value_or(heard.ends_at), heard.ends_at);
    }
  }
  if (!busy_until) return begin(uav, now);
  schedule(*busy_until + settings_.slot + draw_wait(uav), uav, Kind::kAttempt);
}

void Medium::begin(std::size_t uav, SimTime now) {
  Station& own = stations_[uav];
  own.transmission = {uav, now, now + air_time(settings_, own.queue.front().bytes->size())};
  own.disturbed_by.clear();
  for (Station& other : stations_) {
    if (&other == &own || !other.transmission || other.transmission->ends_at <= now) continue;
    own.disturbed_by.push_back(other.transmission->from);
    other.disturbed_by.push_back(uav);
  }
  schedule(own.transmission->ends_at, uav, Kind::kEnd);
}

// --- the receivers ------------------------------------------------------------------------------

void Medium::finish(std::size_t uav, SimTime now, const LinkOf& link_of,
                    std::vector<Arrival>& out) {
  Station& own = stations_[uav];
  for_receivers(own.queue.front(),
                [&](std::size_t to) { out.push_back(receive(own, to, link_of)); });
  own.queue.pop_front();
  own.transmission.reset();
  plan(uav, settings_.access == Access::kCsma ? now + settings_.slot : now, out);
}

// One draw decides with and without the interference: which of both lost it is then known.
Arrival Medium::receive(const Station& sender, std::size_t to, const LinkOf& link_of) const {
  const Message& message = sender.queue.front();
  const Transmission& transmission = *sender.transmission;
  const Link link = link_of(message.from, to);
  const double signal_dbm = power_dbm(message.from, to, link);
  const double noise = noise_dbm(settings_);
  double disturbed = noise;
  bool transmitted = false;
  for (const std::size_t other : sender.disturbed_by) {
    transmitted |= other == to;
    if (other != to) disturbed = sum_dbm(disturbed, power_dbm(other, to, link_of(other, to)));
  }
  KeyedRandom random({.seed = seed_,
                      .stream = random_stream(uavs_[message.from], uavs_[to], "radio loss"),
                      .index = message.sequence});
  const double draw = random.uniform();
  Arrival arrival{.message = message,
                  .to = to,
                  .began_at = transmission.began_at,
                  .at = transmission.ends_at,
                  .link = link,
                  .snr_db = signal_dbm - disturbed};
  const auto is_lost = [&](double noise_dbm) {
    return draw < loss_probability(settings_, signal_dbm - noise_dbm, message.bytes->size());
  };
  if (transmitted) {
    arrival.outcome = Outcome::kHalfDuplex;
  } else if (is_lost(noise)) {
    arrival.outcome = Outcome::kNoise;
  } else if (is_lost(disturbed)) {
    arrival.outcome = Outcome::kCollision;
  }
  return arrival;
}

// Shadowing is the same in both directions, and for the whole run.
double Medium::power_dbm(std::size_t from, std::size_t to, const Link& link) const {
  const auto [first, second] = std::minmax(from, to);
  KeyedRandom random(
      {.seed = seed_, .stream = random_stream(uavs_[first], uavs_[second], "radio shadowing")});
  const double shadowing_db =
      settings_.shadowing_db > 0.0 ? settings_.shadowing_db * random.normal() : 0.0;
  return settings_.tx_power_dbm - path_loss_db(settings_, link, shadowing_db);
}

std::vector<Arrival> Medium::in_transit(SimTime now) const {
  std::vector<Arrival> out;
  const auto add = [&](const Message& message, std::optional<SimTime> began_at) {
    for_receivers(message, [&](std::size_t to) {
      out.push_back({.message = message,
                     .to = to,
                     .outcome = Outcome::kWaiting,
                     .began_at = began_at,
                     .at = std::max({now, message.sent_at, began_at.value_or(now)})});
    });
  };
  for (const Station& station : stations_) {
    for (const Message& message : station.queue) {
      const bool is_first = &message == &station.queue.front();
      add(message, is_first && station.transmission ? std::optional(station.transmission->began_at)
                                                    : std::nullopt);
    }
  }
  for (auto rest = events_; !rest.empty(); rest.pop())
    if (rest.top().message.bytes) add(rest.top().message, std::nullopt);
  std::ranges::stable_sort(out, {}, [](const Arrival& arrival) {
    return std::tuple(arrival.message.from, arrival.message.sequence, arrival.to);
  });
  return out;
}

}  // namespace tether::radio
