#include "joining.h"

#include <gtest/gtest.h>

namespace tether::supervisor {
namespace {

using namespace std::chrono_literals;

TEST(Joining, HoldsTheCommandFromTheRequestToTheAnswerOrItsLimit) {
  Joining joining(10s);
  EXPECT_FALSE(joining.must_be_stopped(1s));
  EXPECT_TRUE(joining.is_to_come());
  joining.asked(2s);
  EXPECT_FALSE(joining.is_to_come());
  EXPECT_TRUE(joining.must_be_stopped(2s));
  EXPECT_TRUE(joining.must_be_stopped(11s));
  EXPECT_FALSE(joining.must_be_stopped(12s));
  EXPECT_EQ(joining.until(), Duration(12s));
  joining.over();
  EXPECT_FALSE(joining.must_be_stopped(3s));
  EXPECT_FALSE(joining.until());
  joining.asked(4s);
  EXPECT_FALSE(joining.must_be_stopped(5s)) << "it is over, as after an interrupt";
}

}  // namespace
}  // namespace tether::supervisor
