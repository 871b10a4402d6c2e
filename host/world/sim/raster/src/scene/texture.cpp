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

// The next smaller version. Odd sizes are averaged exactly, as parts of pixels.
Image make_smaller(const Image& from) {
  Image to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
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

void add_level(const Image& image, PreparedScene& scene) {
  const int stride = image.width + 2;
  const auto texel = [&](int x, int y) {
    const int column = (x + image.width) % image.width;
    const int row = (y + image.height) % image.height;
    return image.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(column)];
  };
  scene.levels.push_back({static_cast<std::int32_t>(scene.texels.size()) + stride + 1, stride,
                          256.0F * static_cast<float>(image.width),
                          256.0F * static_cast<float>(image.height)});
  for (int y = -1; y < image.height; ++y) {
    for (int x = -1; x <= image.width; ++x) {
      scene.texels.push_back(pair_of(texel(x, y), texel(x, y + 1)));
    }
  }
}

}  // namespace

std::int32_t add_texture(const Texture& texture, PreparedScene& scene) {
  const std::size_t before = scene.levels.size();
  Image image{texture.width_px, texture.height_px, {}};
  for (std::size_t i = 0; i < texture.rgba.size(); i += 4) {
    image.texels.push_back(packed(texture.rgba.data() + i));
  }
  add_level(image, scene);
  while (image.width > 1 || image.height > 1) {
    image = make_smaller(image);
    add_level(image, scene);
  }
  return static_cast<std::int32_t>(scene.levels.size() - before);
}

}  // namespace tether::raster
