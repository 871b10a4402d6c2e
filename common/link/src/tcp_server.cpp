#include "peer.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <poll.h>
#include <time.h>

#include <tether/base/error.h>
#include <tether/link/server.h>
#include <tether/link/socket.h>

/// The coordinator's end over TCP: one `ppoll` per poll over the listening socket and all peers. A
/// Peer reads, queues and writes; this file accepts connections, enforces the limits on strangers,
/// and reports at most one event per peer and poll. Before it sleeps, it reads from the peer that
/// sent last for a moment (look_out), because its next request often follows at once.
namespace tether::link {
namespace {

using std::chrono::steady_clock;

/// After a failed accept (no descriptors left), how long before the next try.
constexpr std::chrono::milliseconds kAcceptPause{100};
/// Successful look-outs in a row before the other peers are served again.
constexpr int kMaxLookOuts = 16;
/// On destruction, how long unsent frames may take.
constexpr std::chrono::seconds kFinishLimit{1};

class TcpServer final : public Server {
 public:
  TcpServer(const Address& address, Duration hello_timeout);
  ~TcpServer() override;

  Address address() const override { return address_; }
  std::span<Event> poll(Duration max_wait) override;
  void send(PeerId id, Message message) override;
  std::uint64_t moved_bytes(PeerId id) override;
  void close(PeerId id) override;

 private:
  Peer* find(PeerId id);
  bool is_full() const;
  /// The peer's deadline; sooner while other connections wait.
  Peer::Deadline deadline_of(const Peer& peer) const;
  /// The earliest of the deadlines, or none.
  Peer::Deadline next_deadline() const;

  // The parts of poll(), in order.
  void report_and_remove_dead();
  bool look_out(Duration max_wait);
  bool wait(Duration max_wait);
  void accept_all();
  void accept_one(Accepted accepted);
  void serve(Peer& peer, int happened);
  bool receive(Peer& peer);
  void handle_frame(Peer& peer);
  void expire_deadlines();

  void refuse(Peer& peer, const Failure& failure);
  /// Reports the end of an open peer, unless it was reported.
  static void lose(Peer& peer, const Failure& failure);

  Descriptor acceptor_;
  Address address_;
  Duration hello_timeout_;
  std::vector<Event> events_;  // of the last poll
  Encoder encoder_;
  std::vector<std::unique_ptr<Peer>> peers_;  // in the order of their ids
  std::vector<pollfd> watched_;               // the acceptor, then peers_ in order
  PeerId next_id_ = 1;
  Peer::Deadline accept_paused_until_;
  bool is_crowded_ =
      false;  // full of strangers while others wait; the acceptor is not watched then
  LookOut look_out_;
  PeerId spoke_last_ = 0;
  int look_outs_ = 0;
};

TcpServer::TcpServer(const Address& address, Duration hello_timeout)
    : hello_timeout_(std::min(hello_timeout, kLongestTimeout)) {
  auto listening = listen_on_tcp(address);
  if (!listening) {
    throw Error(ErrorCode::kSetup,
                listening.failure().message +
                    " (choose an address of this machine and a free port; port 0 takes any)")
        .about(to_string(address));
  }
  acceptor_ = std::move(*listening);
  set_blocking(acceptor_.get(), false);
  address_ = local_address(acceptor_.get());
}

TcpServer::~TcpServer() {
  const auto end = steady_clock::now() + kFinishLimit;
  for (auto& peer : peers_) peer->finish(end);
}

Peer* TcpServer::find(PeerId id) {
  const auto found = std::ranges::lower_bound(peers_, id, {}, &Peer::id);
  return found == peers_.end() || (*found)->id() != id ? nullptr : found->get();
}

// --- sending ------------------------------------------------------------------------------------

void TcpServer::send(PeerId id, Message message) {
  Peer* const peer = find(id);
  if (peer == nullptr || peer->state() != Peer::State::kOpen) return;
  if (const Status valid = validate(message); !valid) {
    throw Error(ErrorCode::kInternal,
                "message to " + peer->remote() + " cannot be sent: " + valid.failure().message);
  }
  const FramePieces pieces = encoder_.encode_pieces(message);
  if (!pieces.image.empty()) spoke_last_ = 0;  // reading it takes the peer too long
  if (const Status sent = peer->send(pieces, message); !sent) lose(*peer, sent.failure());
}

std::uint64_t TcpServer::moved_bytes(PeerId id) {
  const Peer* const peer = find(id);
  return peer == nullptr || peer->state() == Peer::State::kDead ? 0 : peer->moved_bytes();
}

void TcpServer::close(PeerId id) {
  Peer* const peer = find(id);
  if (peer == nullptr) return;
  peer->closing.reset();
  peer->drain();
}

void TcpServer::refuse(Peer& peer, const Failure& failure) {
  std::string text = failure.message.substr(0, kMaxTextBytes);
  send(peer.id(), Refusal{Refusal::Reason::kBadMessage, std::move(text)});
  peer.drain();
  if (!peer.closing) peer.closing = failure;
}

// --- polling ------------------------------------------------------------------------------------

void TcpServer::lose(Peer& peer, const Failure& failure) {
  if (!peer.input_has_ended()) peer.closing = failure;
}

std::span<Event> TcpServer::poll(Duration max_wait) {
  events_.clear();
  for (const auto& peer : peers_) {
    if (peer->may_have_frame()) handle_frame(*peer);
  }
  report_and_remove_dead();
  if (events_.empty() && look_out(max_wait)) return events_;
  if (wait(events_.empty() ? max_wait : Duration::zero())) {
    // Peers that come now are served the next time.
    const std::size_t served = peers_.size();
    if (watched_[0].revents != 0) accept_all();
    for (std::size_t i = 0; i < served; ++i) {
      if (watched_[i + 1].revents != 0) serve(*peers_[i], watched_[i + 1].revents);
    }
  }
  expire_deadlines();
  report_and_remove_dead();
  return events_;
}

bool TcpServer::look_out(Duration max_wait) {
  Peer* const peer = find(std::exchange(spoke_last_, 0));
  const bool worth_it = peer != nullptr && max_wait > kLookOut && !peer->wants_to_write() &&
                        look_outs_ < kMaxLookOuts && look_out_.is_due();
  if (worth_it) {
    const auto end = steady_clock::now() + kLookOut;
    while (peer->state() == Peer::State::kOpen && steady_clock::now() < end) {
      if (!receive(*peer)) continue;
      ++look_outs_;
      look_out_.done(true);
      return true;
    }
    look_out_.done(false);
  }
  look_outs_ = 0;
  return false;
}

bool TcpServer::wait(Duration max_wait) {
  is_crowded_ = is_crowded_ && is_full();
  Duration limit = max_wait;
  if (const auto deadline = next_deadline()) {
    limit = std::min(limit, std::max<Duration>(*deadline - steady_clock::now(), Duration::zero()));
  }
  watched_.resize(peers_.size() + 1);
  const bool may_accept = !accept_paused_until_ && !is_crowded_;
  watched_[0] = {may_accept ? acceptor_.get() : -1, POLLIN, 0};
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    const Peer& peer = *peers_[i];
    const int in = peer.input_has_ended() ? 0 : POLLIN;
    const int out = peer.wants_to_write() ? POLLOUT : 0;
    // A peer that already has an event gets none from its socket in this poll.
    const int descriptor = peer.may_have_frame() ? -1 : peer.descriptor();
    watched_[i + 1] = {descriptor, static_cast<short>(in | out), 0};
  }
  const std::int64_t ns = limit.count();
  const timespec timeout{ns / 1'000'000'000, ns % 1'000'000'000};
  return ::ppoll(watched_.data(), watched_.size(), &timeout, nullptr) > 0;
}

bool TcpServer::is_full() const {
  const auto is_stranger = [](const auto& peer) { return peer->is_stranger(); };
  return std::count_if(peers_.begin(), peers_.end(), is_stranger) >=
         static_cast<std::ptrdiff_t>(kMaxStrangers);
}

Peer::Deadline TcpServer::deadline_of(const Peer& peer) const {
  if (!is_crowded_ || !peer.is_stranger() || !peer.deadline) return peer.deadline;
  return std::min(*peer.deadline, peer.since() + kCrowdedStay);
}

Peer::Deadline TcpServer::next_deadline() const {
  Peer::Deadline next = accept_paused_until_;
  for (const auto& peer : peers_) {
    const auto deadline = deadline_of(*peer);
    if (deadline && (!next || *deadline < *next)) next = deadline;
  }
  return next;
}

void TcpServer::accept_all() {
  is_crowded_ = is_full();
  while (!is_full()) {
    Accepted accepted = accept_tcp(acceptor_.get());
    if (!accepted.error) {
      accept_one(std::move(accepted));
    } else if (accepted.error != std::errc::connection_aborted) {
      const bool none_left = accepted.error == std::errc::operation_would_block;
      if (!none_left) accept_paused_until_ = steady_clock::now() + kAcceptPause;
      return;
    }
  }
}

void TcpServer::accept_one(Accepted accepted) {
  peers_.push_back(
      std::make_unique<Peer>(next_id_++, std::move(accepted.socket), to_string(accepted.remote)));
  Peer& peer = *peers_.back();
  peer.deadline = peer.since() + hello_timeout_;
  events_.push_back({peer.id(), Connected{peer.remote()}});
}

void TcpServer::serve(Peer& peer, int happened) {
  if (peer.state() == Peer::State::kDead) return;
  if (happened & POLLOUT) {
    const bool is_open = peer.state() == Peer::State::kOpen;
    if (const Status flushed = peer.flush(); !flushed) {
      if (is_open) lose(peer, flushed.failure());
      return;
    }
  }
  if ((happened & ~POLLOUT) == 0 || peer.state() == Peer::State::kDead) return;
  if (peer.input_has_ended()) return peer.die();  // it hung up, or was reset
  if (peer.state() == Peer::State::kDraining) return peer.discard_input();
  receive(peer);
}

bool TcpServer::receive(Peer& peer) {
  const auto received = peer.receive();
  if (!received && peer.input_has_ended() && !peer.is_stranger()) {
    events_.push_back({peer.id(), Closed{received.failure(), true}});
  } else if (!received) {
    peer.die();
    peer.closing = received.failure();
  } else if (*received) {
    handle_frame(peer);
  }
  return !received || *received;
}

void TcpServer::handle_frame(Peer& peer) {
  const auto frame = peer.next_frame();
  if (!frame) return refuse(peer, frame.failure());
  if (frame->empty()) return;
  auto message = decode(*frame);
  if (!message) return refuse(peer, message.failure());
  spoke_last_ = peer.id();
  events_.push_back({peer.id(), std::move(message).value()});
}

void TcpServer::expire_deadlines() {
  const auto deadline = next_deadline();
  if (!deadline) return;
  const auto now = steady_clock::now();
  if (accept_paused_until_ && *accept_paused_until_ <= now) accept_paused_until_.reset();
  for (const auto& entry : peers_) {
    Peer& peer = *entry;
    const auto its_deadline = deadline_of(peer);
    if (!its_deadline || *its_deadline > now) continue;
    const bool is_draining = peer.state() == Peer::State::kDraining;
    if (!is_draining)
      refuse(peer, {Failure::Kind::kTimeout,
                    "timed out: no complete Hello message within the time limit"});
    // Another connection needs its place: do not wait until it has read the Refusal.
    if (is_draining || is_crowded_) peer.die();
  }
}

void TcpServer::report_and_remove_dead() {
  for (const auto& peer : peers_) {
    if (auto failure = std::exchange(peer->closing, std::nullopt))
      events_.push_back({peer->id(), Closed{std::move(*failure)}});
  }
  std::erase_if(peers_, [](const auto& peer) { return peer->state() == Peer::State::kDead; });
}

}  // namespace

std::unique_ptr<Server> listen_tcp(const Address& address, Duration hello_timeout) {
  return std::make_unique<TcpServer>(address, hello_timeout);
}

}  // namespace tether::link
