#include "commands/commands.h"
#include "options/common_options.h"
#include "reading/file_kind.h"
#include "terminal/print.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/record/reader.h>

namespace tether::app {

namespace {

struct AuditOptions {
  std::filesystem::path record;
  std::uint64_t max_findings = 20;
};

/// Checks a record against the rules of time.
int audit_record(const AuditOptions& options, const std::stop_token&) {
  require_kind(options.record, FileKind::kRecord);
  const record::Record record = record::read_record(options.record);
  if (const std::string damage = record::describe_damage(record); !damage.empty())
    complain("warning: " + options.record.string() + ": " + damage);
  const audit::Verdict verdict = audit::audit(record);
  print(audit::to_text(verdict, options.max_findings));
  return verdict.passed() ? 0 : 1;
}

Options audit_rows(AuditOptions& o) {
  return {
      record_argument(o.record),
      {"--max-findings", "Maximum number of findings to print", &o.max_findings, range(0, 1e9)}};
}

}  // namespace

Command audit_command() {
  return make_command(
      "audit", "Check a record against the rules of time", audit_rows,
      R"(Exit codes: 0 all rules are kept, 1 a rule is violated or the record is incomplete.

Messages that were removed, repeated or moved are found, too, and impossible motion, but no change
that is consistent everywhere. Of a truncated record, it prints the simulated time up to which the
record goes.

Example:
  tether audit out/one/record.mcap)",
      audit_record);
}

}  // namespace tether::app
