#include "remote_session.h"

#include <algorithm>
#include <chrono>

#include <tether/base/text.h>

namespace tether::sim {
namespace {

using Kind = Failure::Kind;

/// Interval at which `why_give_up` is asked.
constexpr Duration kPatience = std::chrono::milliseconds(100);
/// Time without an answer after which `on_silence` is called.
constexpr Duration kSilence = std::chrono::seconds(1);
const std::string kUnnamed = "the simulator";

std::string in_s(Duration limit) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(limit).count();
  const std::string fraction = std::to_string(1000 + ms % 1000).substr(1);
  return std::to_string(ms / 1000) + (ms % 1000 == 0 ? "" : "." + fraction) + " s";
}

}  // namespace

RemoteSession::RemoteSession(std::unique_ptr<protocol::Connection> connection,
                             RemoteOptions options)
    : connection_(std::move(connection)),
      options_(std::move(options)),
      name_(kUnnamed + (options_.address.empty() ? "" : " at " + options_.address)) {}

RemoteSession::~RemoteSession() {
  connection_->close();
}

protocol::Opened RemoteSession::open(const protocol::Open& request) {
  return take<protocol::Opened>(answer_to(request, options_.open_limit));
}

protocol::Reply RemoteSession::answer_to(const protocol::Request& request, Duration limit) {
  if (const Status sent = connection_->send(request); !sent) throw_lost(sent.failure(), limit);
  auto reply = await(limit);
  if (!reply) throw_lost(reply.failure(), limit);
  if (const auto* failed = std::get_if<protocol::Failed>(&*reply)) {
    const std::string why = printable(failed->message);
    fail("failed" + (why.empty() ? " without a reason" : ": " + why));
  }
  return std::move(*reply);
}

// Counts the time spent listening only: a simulator that was stopped together with this process is
// not silent.
Result<protocol::Reply> RemoteSession::await(Duration limit) {
  Duration waited{0};
  bool reported = name_ == kUnnamed || !options_.on_silence;
  while (true) {
    const Duration patience = std::min(limit - waited, kPatience);
    auto reply = connection_->receive_reply(patience);
    const bool silent = !reply && reply.failure().kind == Kind::kTimeout;
    if (!silent || patience == Duration(0)) return reply;
    check_give_up();
    waited += patience;
    if (reported || waited < kSilence) continue;
    reported = true;
    options_.on_silence("blocked on " + name() + ", which has not answered for " + in_s(kSilence));
  }
}

void RemoteSession::check_give_up() {
  if (!options_.why_give_up) return;
  if (const auto why = options_.why_give_up()) throw Error(ErrorCode::kSetup, *why);
}

void RemoteSession::fail(const std::string& what) const {
  throw Error(ErrorCode::kSetup, name() + " " + what).about(name());
}

void RemoteSession::throw_lost(const Failure& failure, Duration limit) {
  // The owner of the simulator's process knows a better reason why it is gone.
  if (failure.kind == Kind::kDisconnected) check_give_up();
  switch (failure.kind) {
    case Kind::kInvalid:
      throw Error(ErrorCode::kBadFile,
                  "this world cannot be sent to " + name() + ": " + failure.message)
          .about(name());
    case Kind::kTimeout:
      fail("has not answered for " + in_s(limit) +
           "; check that it still runs and serves no other run");
    case Kind::kProtocol:
      fail("violated the protocol: " + failure.message);
    default:
      fail("is lost: " + failure.message);
  }
}

}  // namespace tether::sim
