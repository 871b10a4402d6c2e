#include "remote_session.h"

#include <algorithm>
#include <chrono>

#include <tether/base/printable.h>

namespace tether::sim {
namespace {

using Kind = Failure::Kind;

/// How long an answer is waited for before asking whether there is any use in it.
constexpr Duration kPatience = std::chrono::milliseconds(100);
/// How long before the caller is told that one is waited for.
constexpr Duration kSilence = std::chrono::seconds(1);

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
      name_(options_.address.empty() ? "" : " at " + options_.address) {}

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
    throw Error(ErrorCode::kSetup,
                name() + " failed" + (why.empty() ? " without a reason" : ": " + why));
  }
  return std::move(*reply);
}

// Counts the time that was spent listening: who was stopped together with us is not silent.
Result<protocol::Reply> RemoteSession::await(Duration limit) {
  Duration waited{0};
  bool told = name_.empty() || !options_.on_silence;
  while (true) {
    const Duration patience = std::min(limit - waited, kPatience);
    auto reply = connection_->receive_reply(patience);
    const bool silent = !reply && reply.failure().kind == Kind::kTimeout;
    if (!silent || patience == Duration(0)) return reply;
    give_up_if_told();
    waited += patience;
    if (told || waited < kSilence) continue;
    told = true;
    options_.on_silence("everything waits for " + name() + ", which has not answered for " +
                        in_s(kSilence));
  }
}

void RemoteSession::give_up_if_told() {
  if (!options_.why_give_up) return;
  if (const auto why = options_.why_give_up()) throw Error(ErrorCode::kSetup, *why);
}

void RemoteSession::throw_lost(const Failure& failure, Duration limit) {
  // Who started the simulator knows better why it is gone.
  if (failure.kind == Kind::kDisconnected) give_up_if_told();
  switch (failure.kind) {
    case Kind::kInvalid:
      throw Error(ErrorCode::kBadFile,
                  name() + " cannot be told of this world: " + failure.message);
    case Kind::kTimeout:
      throw Error(ErrorCode::kSetup, name() + " has not answered for " + in_s(limit) +
                                         "; see whether it still runs, and flies no other run");
    case Kind::kProtocol:
      throw Error(ErrorCode::kSetup, name() + " answered what it must not: " + failure.message);
    default:
      throw Error(ErrorCode::kSetup, name() + " is lost: " + failure.message);
  }
}

}  // namespace tether::sim
