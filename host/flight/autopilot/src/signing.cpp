#include <algorithm>
#include <utility>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

using mavlink::SignatureChecker;

// 2026-01-01, since 2015-01-01 [s].
constexpr std::uint64_t kBegin_s = 347'155'200, kPerSecond = 100'000;
constexpr std::uint8_t kLink = 1;

std::uint64_t timestamp(SimTime at) {
  constexpr std::int64_t kUnit_ns = 10'000;
  return kBegin_s * kPerSecond + static_cast<std::uint64_t>(to_ns(at) / kUnit_ns);
}

std::string_view name(SignatureChecker::Verdict verdict) {
  constexpr std::string_view kNames[] = {"", "not_signed", "wrong_signature", "old_signature"};
  return kNames[static_cast<std::size_t>(verdict)];
}

class WithSigning final : public FlightController {
 public:
  WithSigning(std::unique_ptr<FlightController> controller, const mavlink::SigningKey& key)
      : controller_(std::move(controller)), link_(key, kLink, timestamp({})) {}

  void boot(const Sensed& at_rest) override { controller_->boot(at_rest); }

  Actions step(const Sensed& sensed, const std::vector<Bytes>& received) override {
    std::vector<Bytes> taken;
    std::vector<std::size_t> places;  // of these in `received`
    std::vector<Actions::Refusal> refused;
    for (std::size_t i = 0; i < received.size(); ++i) {
      mavlink::SignedLink::Opened opened = link_.open(received[i]);
      if (opened.verdict == SignatureChecker::Verdict::kRight) {
        taken.push_back(std::move(opened.frames));
        places.push_back(i);
      } else {
        refused.push_back({i, name(opened.verdict)});
      }
    }
    Actions actions = controller_->step(sensed, taken);
    for (const auto& [place, why] : actions.refused) refused.push_back({places[place], why});
    std::ranges::sort(refused, {}, &Actions::Refusal::received);
    actions.refused = std::move(refused);
    for (Bytes& bytes : actions.sent) bytes = link_.sign(bytes, timestamp(sensed.at));
    return actions;
  }

  std::string version() const override { return controller_->version(); }

 private:
  std::unique_ptr<FlightController> controller_;
  mavlink::SignedLink link_;
};

}  // namespace

std::string complaint_about_signing_key(std::string_view content) {
  const auto key = mavlink::key_of_file(content);
  return key ? "" : key.failure().message;
}

std::unique_ptr<FlightController> with_signing(std::unique_ptr<FlightController> controller,
                                               std::string_view key) {
  return std::make_unique<WithSigning>(std::move(controller), *mavlink::key_of_file(key));
}

}  // namespace tether::autopilot
