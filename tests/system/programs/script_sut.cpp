// A SUT that does what its arguments say, one call after the other:
//   sleep:MS  send:UAV (send: to all)  receive:MS  turn:RAD_S  abort  finish
#include <cstdio>
#include <cstdlib>
#include <string>

#include <tether/client/simulated_vehicle.h>

namespace {

using tether::Status;
using tether::client::Vehicle;

tether::Duration milliseconds(const std::string& text) {
  return tether::Duration(static_cast<std::int64_t>(std::stod(text) * 1e6));
}

Status do_call(Vehicle& vehicle, const std::string& call, const std::string& value) {
  if (call == "sleep") return vehicle.sleep_for(milliseconds(value));
  if (call == "send") return vehicle.send(value, {});
  if (call == "turn") return vehicle.command_velocity({{}, std::stod(value)});
  if (call == "finish") return vehicle.finish(true, "done");
  if (call == "abort") std::abort();
  const auto message = vehicle.receive(milliseconds(value));
  const bool is_good = message || message.failure().kind == tether::Failure::Kind::kNothingYet;
  return is_good ? tether::ok_status() : Status(message.failure());
}

}  // namespace

int main(int argc, char** argv) {
  auto options = tether::client::options_from_environment();
  auto vehicle = tether::client::connect(std::move(options).value());
  if (!vehicle) return 3;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t colon = std::min(word.find(':'), word.size());
    const std::string value = colon < word.size() ? word.substr(colon + 1) : "";
    if (const Status done = do_call(**vehicle, word.substr(0, colon), value); !done) {
      std::fprintf(stderr, "%s: %s\n", word.c_str(), done.failure().message.c_str());
      return 3;
    }
  }
  return 0;
}
