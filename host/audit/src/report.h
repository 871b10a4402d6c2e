#pragma once

#include <string>
#include <utility>

#include <tether/audit/audit.h>
#include <tether/base/printable.h>

namespace tether::audit {

/// Takes findings as they come. Names in a record may hold anything; what is told of them is
/// printable.
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
  void add(int rule, const record::Logged<record::Interaction>& entry, std::string what) {
    add({rule, entry.message.uav, entry.message.sequence, entry.at, std::move(what)});
  }
  void add(int rule, const record::Logged<record::CommandEffect>& entry, std::string what) {
    add({rule, entry.message.uav, entry.message.sequence, entry.at, std::move(what)});
  }
  void add(const record::Logged<record::GroundTruth>& entry, std::string what) {
    add({0, entry.message.uav, 0, entry.at, std::move(what)});
  }
  void add(std::string what) { add({0, "", 0, {}, std::move(what)}); }
  void note(const std::string& what) { verdict_.notes.push_back(printable(what)); }

  Verdict& verdict() { return verdict_; }

 private:
  Verdict& verdict_;
};

}  // namespace tether::audit
