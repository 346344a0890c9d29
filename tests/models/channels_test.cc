// Values of action units and angles to tokens and back.
#include "models/channels.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gestus::models {
namespace {

// Levels as the released code of Model 2 lays them out: action units 0 to 4.99 by 0.01.
Channel ActionUnit() {
  Channel c;
  c.step = 0.01f;
  c.levels = 500;
  return c;
}

TEST(ChannelTest, TokensOfLevelsAreTheLevels) {
  Channel angle;
  angle.minimum = -0.731f;
  angle.step = 0.003f;
  angle.levels = 412;
  for (const Channel& c : {ActionUnit(), angle})
    for (std::int32_t token = kFirstLevel; token < c.Tokens(); ++token)
      ASSERT_EQ(c.TokenOf(c.ValueOf(token)), token);
}

TEST(ChannelTest, TakesTheNearestLevel) {
  const Channel c = ActionUnit();
  EXPECT_EQ(c.TokenOf(0.0f), 3);
  EXPECT_EQ(c.TokenOf(0.0049f), 3);
  EXPECT_EQ(c.TokenOf(0.0051f), 4);
  EXPECT_EQ(c.TokenOf(2.504f), 3 + 250);
}

TEST(ChannelTest, WhatLiesBeyondTakesTheLastLevel) {
  const Channel c = ActionUnit();
  EXPECT_EQ(c.TokenOf(-1.0f), 3);
  EXPECT_EQ(c.TokenOf(5.0f), 502);
  EXPECT_EQ(c.TokenOf(HUGE_VALF), 502);
  EXPECT_EQ(c.TokenOf(-HUGE_VALF), 3);
  EXPECT_EQ(c.TokenOf(NAN), kPadToken);
}

}  // namespace
}  // namespace gestus::models
