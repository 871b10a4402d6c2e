#include "commands/commands.h"
#include "reading/file_kind.h"
#include "terminal/print.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/record/reader.h>

namespace tether::app {

int audit_record(const AuditOptions& options, const std::stop_token&) {
  require_kind(options.record, FileKind::kRecord);
  const record::Record record = record::read_record(options.record);
  if (const std::string damage = record::describe_damage(record); !damage.empty())
    complain("warning: " + options.record.string() + ": " + damage);
  const audit::Verdict verdict = audit::audit(record);
  print(audit::to_text(verdict, options.max_findings));
  return verdict.passed() ? 0 : 1;
}

}  // namespace tether::app
