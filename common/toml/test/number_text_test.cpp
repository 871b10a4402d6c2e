#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include <tether/toml/table.h>

namespace tether::toml {
namespace {

TEST(NumberText, IsAsPeopleWriteNumbers) {
  EXPECT_EQ(number_text(25.0), "25");
  EXPECT_EQ(number_text(-0.1), "-0.1");
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(100'000.0), "100000");
  EXPECT_EQ(number_text(9e15), "9000000000000000");
  EXPECT_EQ(number_text(1e16), "1e+16");
  EXPECT_EQ(number_text(1e-4), "0.0001");
  EXPECT_EQ(number_text(1e-5), "1e-05");
  EXPECT_EQ(number_text(-1e300), "-1e+300");
  EXPECT_EQ(number_text(NAN), "nan");
  EXPECT_EQ(number_text(-INFINITY), "-inf");
}

TEST(NumberText, ReadsBackAsTheSameNumber) {
  for (int i = 0; i < 1000; ++i) {
    const double number = std::ldexp(1.0 / (i + 3.0), i % 200 - 100);
    EXPECT_EQ(std::strtod(number_text(number).c_str(), nullptr), number);
  }
}

}  // namespace
}  // namespace tether::toml
