#include <algorithm>
#include <bit>
#include <cstdint>

#include <fmt/format.h>

#include <tether/campaign/campaign_results.h>

namespace tether::campaign {
namespace {

/// FNV-1a over whole words.
class Digest {
 public:
  void add(std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8)
      hash_ = (hash_ ^ ((word >> shift) & 0xffU)) * 0x100000001b3U;
  }
  void add(std::span<const double> numbers) {
    for (const double number : numbers) add(std::bit_cast<std::uint64_t>(number));
  }
  void add(const std::string& text) {
    for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
    add(text.size());
  }
  std::string text() const { return fmt::format("{:016x}", hash_); }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

}  // namespace

std::string flight_digest(const record::Record& record) {
  if (record.ground_truth.empty()) return "";
  Digest digest;
  for (const auto& logged : record.ground_truth) {
    const record::GroundTruth& truth = logged.message;
    digest.add(truth.uav);
    digest.add(static_cast<std::uint64_t>(truth.at.time_since_epoch().count()));
    digest.add(truth.p_WB_m);
    digest.add(truth.q_WB);
    digest.add(truth.v_WB_m_s);
    digest.add(truth.w_WB_B_rad_s);
  }
  return digest.text();
}

bool are_copies(const TrialResult& a, const TrialResult& b) {
  return !a.flight_digest.empty() && a.flight_digest == b.flight_digest && a.outcome == b.outcome &&
         a.metrics == b.metrics && a.clauses == b.clauses;
}

std::vector<const TrialResult*> distinct_flights(std::span<const TrialResult> trials) {
  std::vector<const TrialResult*> distinct;
  for (const TrialResult& trial : trials) {
    const bool is_known = std::ranges::any_of(
        distinct, [&](const TrialResult* other) { return are_copies(*other, trial); });
    if (trial.outcome != Outcome::kFailed && !is_known) distinct.push_back(&trial);
  }
  return distinct;
}

}  // namespace tether::campaign
