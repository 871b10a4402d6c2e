#include <cstdio>

#include <tether/base/error.h>
#include <tether/record/png.h>
#include <tether/record/writer.h>

/// Writes a record with every kind of message, for readers that are not ours:
///   write_sample_record FILE [--torn]
/// Three seconds of ST, so that there are several chunks; --torn leaves it as a run that broke off
/// does.
namespace {

using namespace tether;
using namespace tether::record;

SimTime st_ms(std::int64_t ms) {
  return from_ns<SimTime>(ms * 1'000'000);
}

Header make_header() {
  Header header;
  header.tether_version = "0.1.0";
  header.scenario = "sample";
  header.condition = "host";
  header.policy = kConservativeBarrier;
  header.step = Duration(1'000'000);
  header.suts = {{"uav", "sample", {computer::ClockKind::kScripted}, {}}};
  header.sensors = {{"uav", "range", "range", false, {}, {}}};
  header.anchors = {{"box", "box", {0.4, 0.4, 0.4}, {3, 0, 1}, {1, 0, 0, 0}}};
  return header;
}

Interaction reading(std::uint64_t sequence, SimTime at) {
  Interaction message;
  message.uav = "uav";
  message.sequence = sequence;
  message.kind = kSensor;
  message.sensor = "range";
  message.sample_index = sequence - 1;
  message.request_at = message.reply_at = same_instant(at);
  message.sampled_at = message.sample_state_at = message.available_at = at;
  message.st_at_arrival = message.st_at_release = at;
  return message;
}

void write_messages(Recorder& recorder) {
  const std::vector<std::uint8_t> red_green = {255, 0, 0, 0, 255, 0};
  std::uint64_t sequence = 0;
  for (std::int64_t ms = 0; ms < 3000; ms += 10) {
    const SimTime at = st_ms(ms);
    GroundTruth truth;
    truth.uav = "uav";
    truth.at = at;
    truth.p_WB_m[0] = 0.1 * static_cast<double>(ms);
    recorder.write(at, truth);
    recorder.write(at, reading(++sequence, at));
    if (ms % 100 == 0) {
      recorder.write(at, CommandEffect{"uav", sequence, at, 0.1, 0.2, 0.3, -0.4});
      recorder.write(at,
                     Annotation{"uav", same_instant(at), "roi", R"({"x_px": 1.5, "ok": true})"});
      recorder.write(at, Image{"uav", "camera", at, sequence, encode_png(2, 1, red_green)});
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: write_sample_record FILE [--torn]\n", stderr);
    return 2;
  }
  try {
    const auto recorder = make_mcap_recorder(argv[1]);
    recorder->write(make_header());
    write_messages(*recorder);
    if (argc == 2) {
      Footer footer;
      footer.end = "finished";
      footer.st_at_end = st_ms(2990);
      footer.et_at_end = {same_instant(footer.st_at_end)};
      footer.interactions = 300;
      recorder->write(footer);
    }
    return 0;
  } catch (const tether::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 3;
  }
}
