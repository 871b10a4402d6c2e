// A slow wire as a program of its own: link_proxy TARGET DELAY_MS MBIT_S
//
// Listens on a free port of loopback, prints its address, and passes every connection on to TARGET
// (host:port) with that delay and rate each way, until its standard input ends.
#include <cstdio>
#include <cstdlib>

#include <tether/link_testing/throttling_proxy.h>

int main(int argc, char** argv) {
  using namespace tether;
  if (argc != 4) return 2;
  link_testing::WireModel wire;
  wire.delay = duration_from_seconds(std::atof(argv[2]) * 1e-3);
  wire.bytes_per_s = std::atof(argv[3]) * 1e6 / 8.0;
  const link_testing::ThrottlingProxy proxy({"127.0.0.1", 0}, link::parse_address(argv[1]).value(),
                                            wire);
  std::printf("%s\n", link::to_string(proxy.address()).c_str());
  std::fflush(stdout);
  while (std::getchar() != EOF) {
  }
}
