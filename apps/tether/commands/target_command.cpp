#include "commands/commands.h"
#include "reading/file_kind.h"
#include "terminal/print.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/board/target_probe.h>
#include <tether/os/child_process.h>
#include <tether/scenario/shipped_files.h>
#include <tether/scenario/target.h>

namespace tether::app {

namespace {

struct CheckOptions {
  std::string address;
  bool json = false;
};

using board::Finding;
using board::Health;

struct Check {
  std::string target;
  record::Readings readings;
  std::vector<Finding> findings;
};

// Limits for warnings: round trips in which progress messages do not accumulate, and enough
// bandwidth for uncompressed images of 640 × 480 pixels.
constexpr double kSlowRoundTrip_s = 0.02, kLowBandwidth_MB_s = 5.0;

void add_link(Check& check, const board::Bandwidth& link) {
  const auto add = [&](const char* subject, const std::string& value, bool is_slow) {
    check.findings.push_back(
        {subject, value, is_slow ? Health::kWarn : Health::kOk,
         is_slow ? "not charged to the software, but runs take longer; use a cable" : ""});
  };
  add("round trip over SSH", fmt::format("{:.1f} ms (median)", link.round_trip_s * 1e3),
      link.round_trip_s > kSlowRoundTrip_s);
  add("to the board over SSH", fmt::format("{:.1f} MB/s, encrypted", link.to_board_MB_s),
      link.to_board_MB_s < kLowBandwidth_MB_s);
}

Check check_here() {
  Check check{"this machine", board::probe_here(board::ProbeDepth::kFull), {}};
  if (check.readings.empty())
    throw Error(ErrorCode::kSetup, "the shell (sh) of this machine cannot run the probe");
  check.findings = board::evaluate(check.readings, version());
  return check;
}

Check check_board(const scenario::SshAddress& address, const std::stop_token& stop) {
  board::SshConnection connection(address, stop);
  Check check{
      scenario::to_string(address), board::probe_board(connection, board::ProbeDepth::kFull), {}};
  if (check.readings.empty())
    throw Error(
        ErrorCode::kSetup,
        fmt::format("{} is reachable, but its shell (sh) cannot run the probe", check.target))
        .about(check.target);
  check.findings = board::evaluate(check.readings, version());
  if (const auto link = board::probe_bandwidth(connection))
    add_link(check, *link);
  else
    check.findings.push_back({"connection over SSH", "could not be measured", Health::kWarn,
                              "the board responds too slowly; try again when it is idle"});
  return check;
}

bool has(const Check& check, Health health) {
  return std::ranges::any_of(check.findings,
                             [health](const Finding& f) { return f.health == health; });
}

std::string conclusion(const Check& check) {
  if (has(check, Health::kBad)) return "Findings marked \"bad\" would disturb a measurement.";
  if (has(check, Health::kWarn)) return "Findings marked \"warn\" may disturb a measurement.";
  return "No finding would disturb a measurement.";
}

std::string to_text(const Check& check) {
  std::string text = check.target + "\n";
  for (const Finding& finding : check.findings)
    text += fmt::format("  {:<5}{:<22} {}{}\n",
                        finding.health == Health::kOk ? "" : board::name(finding.health),
                        finding.subject, finding.value,
                        finding.advice.empty() ? "" : fmt::format("  ({})", finding.advice));
  return text + conclusion(check) + "\n";
}

std::string to_json(const Check& check) {
  nlohmann::ordered_json json{{"target", check.target}, {"fine", !has(check, Health::kBad)}};
  for (const Finding& finding : check.findings)
    json["findings"].push_back({{"subject", finding.subject},
                                {"value", finding.value},
                                {"health", board::name(finding.health)},
                                {"advice", finding.advice}});
  json["readings"] = check.readings;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// Reports what would disturb a measurement on a machine.
int check_target(const CheckOptions& options, const std::stop_token& stop) {
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  if (shipped.has(scenario::ShippedKind::kTarget, options.address) ||
      kind_of(options.address) == FileKind::kTarget)
    throw Error(ErrorCode::kUsage,
                fmt::format("\"{}\" describes a virtual target, which runs on this machine. To "
                            "check this machine, type: tether target check",
                            options.address))
        .about(options.address);
  const Check check = options.address.empty()
                          ? check_here()
                          : check_board(scenario::parse_ssh_address(options.address), stop);
  if (options.json)
    fmt::print("{}", to_json(check));
  else
    print(to_text(check));
  return has(check, Health::kBad) ? 1 : 0;
}

Options target_check_rows(CheckOptions& o) {
  return {{"address", "ssh://[user@]board[:port] [this machine]", &o.address},
          {"--json", "Print findings and readings as JSON", &o.json}};
}

}  // namespace

Command target_check_command() {
  return make_command(
      "target check", "Report what would disturb a measurement on a machine", target_check_rows,
      R"(Exit codes: 0 nothing would disturb a measurement, 1 something would, 2 wrong use,
3 the machine cannot be reached.

Examples:
  tether target check
  tether target check ssh://pi@board.local)",
      check_target);
}

}  // namespace tether::app
