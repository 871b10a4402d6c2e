#include <array>
#include <cerrno>

#include <sys/random.h>

#include <tether/base/error.h>
#include <tether/link/server.h>
#include <tether/link/socket.h>

namespace tether::link {

std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  const ssize_t got = uninterrupted([&] { return ::getrandom(bytes.data(), bytes.size(), 0); });
  if (got != static_cast<ssize_t>(bytes.size())) {
    throw Error(ErrorCode::kSetup, "cannot create a token: " + reason_of(errno));
  }
  constexpr char kHex[] = "0123456789abcdef";
  std::string token;
  for (unsigned char byte : bytes) {
    token += kHex[byte >> 4];
    token += kHex[byte & 15];
  }
  return token;
}

bool tokens_equal(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |=
        static_cast<unsigned char>(a[i]) ^ static_cast<unsigned>(static_cast<unsigned char>(b[i]));
  }
  return difference == 0;
}

}  // namespace tether::link
