#include "scene/prepared_scene.h"

#include <algorithm>

namespace tether::raster {
namespace {

using Texels = std::vector<std::uint32_t>;

std::uint32_t packed(const std::uint8_t* rgba) {
  return static_cast<std::uint32_t>(rgba[0]) | static_cast<std::uint32_t>(rgba[1]) << 8U |
         static_cast<std::uint32_t>(rgba[2]) << 16U | static_cast<std::uint32_t>(rgba[3]) << 24U;
}

// The part of a source line that one of `to` pixels covers when it is made of `from`: up to three
// pixels, weighted by how much of each is covered. Weights are in units of 1/to.
struct Span {
  int first;
  int count;
  std::array<std::uint64_t, 3> weights;

  Span(int at, int from, int to) : first(at * from / to), count(0), weights{} {
    const int begin = at * from;
    const int end = begin + from;
    for (int p = first; p * to < end; ++p) {
      const int covered = std::min(end, (p + 1) * to) - std::max(begin, p * to);
      weights[static_cast<std::size_t>(count++)] = static_cast<std::uint64_t>(covered);
    }
  }
};

std::uint32_t mean(const std::uint32_t* texels, int stride, const Span& columns, const Span& rows) {
  std::array<std::uint64_t, 4> sum{};
  std::uint64_t total = 0;
  for (int r = 0; r < rows.count; ++r) {
    for (int c = 0; c < columns.count; ++c) {
      const std::uint64_t weight =
          rows.weights[static_cast<std::size_t>(r)] * columns.weights[static_cast<std::size_t>(c)];
      const std::uint32_t texel = texels[(rows.first + r) * stride + columns.first + c];
      for (unsigned i = 0; i < 4; ++i) sum[i] += weight * (texel >> (8 * i) & 0xFFU);
      total += weight;
    }
  }
  std::uint32_t result = 0;
  for (unsigned i = 0; i < 4; ++i) {
    result |= static_cast<std::uint32_t>((sum[i] + total / 2) / total) << (8 * i);
  }
  return result;
}

// A size of a texture.
struct Image {
  int width, height;
  Texels texels;
};

// The mean of four whole texels, as `mean` has it.
std::uint32_t mean_of_four(const std::uint32_t* upper, const std::uint32_t* lower) {
  constexpr std::uint32_t kEven = 0x00FF00FFU;
  const auto sum = [&](unsigned shift) {
    return (upper[0] >> shift & kEven) + (upper[1] >> shift & kEven) + (lower[0] >> shift & kEven) +
           (lower[1] >> shift & kEven) + 0x00020002U;
  };
  return (sum(0) >> 2U & kEven) | (sum(8) >> 2U & kEven) << 8U;
}

// The next smaller version. Odd sizes are averaged exactly, as parts of pixels.
Image make_smaller(const Image& from) {
  Image to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
  to.texels.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
  if (from.width == 2 * to.width && from.height == 2 * to.height) {
    const auto width = static_cast<std::size_t>(from.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(to.height); ++y) {
      const std::uint32_t* const upper = from.texels.data() + 2 * y * width;
      for (std::size_t x = 0; x < width; x += 2)
        to.texels.push_back(mean_of_four(upper + x, upper + width + x));
    }
    return to;
  }
  for (int y = 0; y < to.height; ++y) {
    const Span rows(y, from.height, to.height);
    for (int x = 0; x < to.width; ++x) {
      to.texels.push_back(
          mean(from.texels.data(), from.width, Span(x, from.width, to.width), rows));
    }
  }
  return to;
}

TexelPair pair_of(std::uint32_t upper, std::uint32_t lower) {
  TexelPair pair{};
  for (unsigned i = 0; i < 4; ++i) {
    const auto less = [&](std::uint32_t texel) {
      return static_cast<std::int8_t>(static_cast<int>(texel >> (8 * i) & 0xFFU) - 128);
    };
    pair.channels[i] = {less(upper), less(lower)};
  }
  return pair;
}

void add_level(const Image& image, PreparedTextures& out) {
  const int stride = image.width + 2;
  const auto width = static_cast<std::size_t>(image.width);
  const auto row = [&](int y) {
    return image.texels.data() +
           static_cast<std::size_t>((y + image.height) % image.height) * width;
  };
  out.levels.push_back({static_cast<std::int32_t>(out.texels.size()) + stride + 1, stride,
                        256.0F * static_cast<float>(image.width),
                        256.0F * static_cast<float>(image.height)});
  for (int y = -1; y < image.height; ++y) {
    const std::uint32_t *upper = row(y), *lower = row(y + 1);
    out.texels.push_back(pair_of(upper[width - 1], lower[width - 1]));
    for (std::size_t x = 0; x < width; ++x) out.texels.push_back(pair_of(upper[x], lower[x]));
    out.texels.push_back(pair_of(upper[0], lower[0]));
  }
}

}  // namespace

std::size_t texels_of(const Texture& texture) {
  std::size_t sum = 0;
  for (int w = texture.width_px, h = texture.height_px;;
       w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    sum += (static_cast<std::size_t>(w) + 2) * (static_cast<std::size_t>(h) + 1);
    if (w <= 1 && h <= 1) return sum;
  }
}

std::int32_t add_texture(const Texture& texture, PreparedTextures& out) {
  const std::size_t before = out.levels.size();
  Image image{texture.width_px, texture.height_px, {}};
  image.texels.reserve(texture.rgba.size() / 4);
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
    image.texels.push_back(packed(texture.rgba.data() + i));
  }
  add_level(image, out);
  while (image.width > 1 || image.height > 1) {
    image = make_smaller(image);
    add_level(image, out);
  }
  return static_cast<std::int32_t>(out.levels.size() - before);
}

}  // namespace tether::raster
