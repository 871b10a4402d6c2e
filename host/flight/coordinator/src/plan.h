#pragma once

#include "controller_links.h"
#include "radio_traffic.h"
#include "sessions/session.h"
#include "stepper.h"
#include "time/timeline.h"

/// What a request does, and when.
namespace tether::coordinator {

/// "sensor", "command", "sleep", "finish", "send", "receive", "battery".
const char* kind_of(const link::Request& request);

/// A request arrives at its instant: its entry, with its timestamp.
PendingInteraction arrive(const Session& session, Sent sent, Timeline& time);

/// What requests are for.
struct Parts {
  Stepper& stepper;
  RadioTraffic& radio;
  ControllerLinks& controllers;
};
/// Plans what it does, and notes it in its entry. Returns the timestamp of its reply.
ExecTime plan(Session& session, PendingInteraction& pending, const Parts& parts);

}  // namespace tether::coordinator
