#include "commands.h"
#include "say.h"

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/record/reader.h>

namespace tether::app {

namespace {
struct AuditOptions {
  std::filesystem::path record;
  std::size_t max_findings = 20;
};

int run(const AuditOptions& options) {
  const record::Record record = record::read_record(options.record);
  if (!record.damage.empty()) say("warning: {}: {}\n", options.record.string(), record.damage);
  const audit::Verdict verdict = audit::audit(record);
  fmt::print("{}", audit::to_text(verdict, options.max_findings));
  return verdict.passed() ? 0 : 1;
}
}  // namespace

void add_audit_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = program.add_subcommand(
      "audit", "Check a record against the rules of time, from the record alone");
  command->add_option("record", options->record, "record.mcap of a run")->required();
  command->add_option("--max-findings", options->max_findings, "Print at most this many")
      ->check(CLI::Range(0.0, 1e9))
      ->capture_default_str();
  command->footer(R"(Exit code 0: every rule is kept; 1: not, or the record has no end.

Example:
  tether audit out/one/record.mcap)");
  command->callback(
      [options, &action] { action = [options](const std::stop_token&) { return run(*options); }; });
}

}  // namespace tether::app
