#pragma once

#include "exact.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include <tether/audit/audit.h>
#include <tether/base/text.h>

namespace tether::audit {

/// Collects findings. Names in a record can contain any bytes; findings are printable.
class Report {
 public:
  explicit Report(Verdict& verdict) : verdict_(verdict) {}

  void add(Finding finding) {
    if (verdict_.findings.size() >= kMaxFindings) {
      ++verdict_.further_findings;
      return;
    }
    finding.uav = printable(finding.uav);
    finding.what = printable(finding.what);
    verdict_.findings.push_back(std::move(finding));
  }
  /// A finding at a message. `what` and `parts` are fmt's; times as `ns` writes them.
  template <class Message, class... Parts>
  void add(int rule, const record::Logged<Message>& entry, fmt::format_string<const Parts&...> what,
           const Parts&... parts) {
    std::uint64_t sequence = 0;
    if constexpr (requires { entry.message.sequence; }) sequence = entry.message.sequence;
    add({rule, entry.message.uav, sequence, entry.at, fmt::format(what, parts...)});
  }
  /// Rule 0, of the whole record.
  void add(std::string what) { add({0, "", 0, {}, std::move(what)}); }
  void note(const std::string& what) { verdict_.notes.push_back(printable(what)); }

  Verdict& verdict() { return verdict_; }

 private:
  Verdict& verdict_;
};

}  // namespace tether::audit
