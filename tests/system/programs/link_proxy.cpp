// A slow wire as a program of its own: link_proxy LISTEN_PORT TARGET [--delay-ms D] [--mbit-s R]
//
// Listens on loopback (port 0: any free one; the port is printed), and passes every connection on
// to TARGET (host:port) with a delay and a limited rate each way, until its standard input ends or
// a signal stops it.

#include <cstdio>
#include <cstdlib>
#include <string>

#include <tether/base/error.h>
#include <tether/link_testing/throttling_proxy.h>

namespace {

using tether::ErrorCode;

double number(const std::string& text, double most) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || !(value >= 0.0 && value <= most)) {
    throw tether::Error(ErrorCode::kUsage,
                        "'" + text + "' is not a number from 0 to " + std::to_string(most));
  }
  return value;
}

tether::link_testing::WireModel parse_wire(int argc, char** argv) {
  tether::link_testing::WireModel wire;
  for (int i = 3; i < argc; i += 2) {
    const std::string option = argv[i];
    const std::string value = i + 1 < argc ? argv[i + 1] : "";
    if (option == "--delay-ms") {
      wire.delay = tether::duration_from_seconds(number(value, 1e6) * 1e-3);
    } else if (option == "--mbit-s") {
      wire.bytes_per_s = number(value, 1e6) * 1e6 / 8.0;
    } else {
      throw tether::Error(ErrorCode::kUsage, "unknown option '" + option + "'");
    }
  }
  return wire;
}

int run(int argc, char** argv) {
  if (argc < 3) {
    throw tether::Error(ErrorCode::kUsage,
                        "usage: link_proxy LISTEN_PORT TARGET [--delay-ms D] [--mbit-s R]");
  }
  const auto listen = tether::link::parse_address(std::string("127.0.0.1:") + argv[1]);
  if (!listen) throw tether::Error(ErrorCode::kUsage, listen.failure().message);
  const auto target = tether::link::parse_address(argv[2]);
  if (!target) throw tether::Error(ErrorCode::kUsage, target.failure().message);
  const tether::link_testing::ThrottlingProxy proxy(*listen, *target, parse_wire(argc, argv));
  std::printf("%s\n", tether::link::to_string(proxy.address()).c_str());
  std::fflush(stdout);
  while (std::getchar() != EOF) {
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const tether::Error& error) {
    std::fprintf(stderr, "link_proxy: %s\n", error.what());
    return tether::exit_code(error.code());
  }
}
