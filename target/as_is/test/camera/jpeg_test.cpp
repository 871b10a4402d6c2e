#include "camera/jpeg.h"

#include <cmath>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>
#include <turbojpeg.h>

namespace tether::as_is {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// By the library that most programs decode with; empty: it finds something wrong.
Bytes decoded(const Bytes& jpeg, int width_px, int height_px) {
  const tjhandle reader = tjInitDecompress();
  int width = 0, height = 0, subsampling = 0, colours = 0;
  Bytes rgb(static_cast<std::size_t>(width_px * height_px) * 3);
  const bool is_good = tjDecompressHeader3(reader, jpeg.data(), jpeg.size(), &width, &height,
                                           &subsampling, &colours) == 0 &&
                       width == width_px && height == height_px && subsampling == TJSAMP_422 &&
                       tjDecompress2(reader, jpeg.data(), jpeg.size(), rgb.data(), width, 0, height,
                                     TJPF_RGB, TJFLAG_STOPONWARNING) == 0;
  tjDestroy(reader);
  return is_good ? rgb : Bytes();
}

template <class Value>
Bytes picture(int width_px, int height_px, Value value) {
  Bytes rgb;
  for (int y = 0; y < height_px; ++y)
    for (int x = 0; x < width_px; ++x)
      for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<std::uint8_t>(value(x, y, c)));
  return rgb;
}

Bytes jpeg_of(const Bytes& rgb, int width_px, int height_px) {
  Bytes out(most_jpeg_bytes(width_px, height_px));
  out.resize(write_jpeg(rgb, width_px, height_px, out.data()));
  return out;
}

double mean_error(const Bytes& a, const Bytes& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

TEST(Jpeg, OfAnySizeShowsThePicture) {
  for (const auto& [width_px, height_px] :
       {std::pair{640, 480}, {33, 17}, {16, 8}, {17, 9}, {2, 3}, {1, 1}}) {
    const Bytes rgb = picture(width_px, height_px, [](int x, int y, int c) {
      return 128.0 + 100.0 * std::sin(0.02 * x + 0.03 * y + c);
    });
    const Bytes seen = decoded(jpeg_of(rgb, width_px, height_px), width_px, height_px);
    ASSERT_EQ(seen.size(), rgb.size()) << width_px;
    EXPECT_LT(mean_error(seen, rgb), 2.0) << width_px;
  }
}

// Largest steps of all frequencies: longest codes, and many bytes of ones.
TEST(Jpeg, OfTheWorstPicturesIsWholeAndWithinItsRoom) {
  std::srand(1);
  for (const int range : {2, 256}) {
    const Bytes rgb =
        picture(160, 120, [&](int, int, int) { return std::rand() % range * 255 / (range - 1); });
    const Bytes jpeg = jpeg_of(rgb, 160, 120);
    EXPECT_LT(jpeg.size(), most_jpeg_bytes(160, 120));
    EXPECT_EQ(decoded(jpeg, 160, 120).size(), rgb.size());
  }
}

TEST(Jpeg, KeepsLightAndColour) {
  for (int colour = 0; colour < 27; ++colour) {
    const int value[] = {colour % 3 * 120, colour / 3 % 3 * 120, colour / 9 * 120};
    const Bytes rgb = picture(32, 16, [&](int, int, int c) { return value[c]; });
    EXPECT_LT(mean_error(decoded(jpeg_of(rgb, 32, 16), 32, 16), rgb), 2.5) << colour;
  }
}

}  // namespace
}  // namespace tether::as_is
