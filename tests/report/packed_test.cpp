// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/packed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "kinfer/base/rng.hpp"

namespace kinfer::report {
namespace {

using nlohmann::json;

std::string encoded(const std::string& text) {
  return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

std::vector<unsigned char> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((bits += 6) >= 8) bytes.push_back(static_cast<unsigned char>(word >> (bits -= 8)));
  }
  return bytes;
}

/// As web/src/packed.ts does it; NaN where nothing was measured.
std::vector<double> unpacked(const json& p) {
  const auto bytes = decoded(p.at("packed"));
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const int steps = bytes[i] + 256 * bytes[i + 1];
    values.push_back(steps == 65535 ? NAN : p.at("zero").get<double>() + p.at("step").get<double>() * steps);
  }
  return values;
}

TEST(Packed, Base64IsThatOfTheRfc) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Packed, NumbersSpanAllCodesAndAMissingOneIsTheLastCode) {
  const json p = packed(std::vector{-2.0, std::nan(""), 4.0});
  EXPECT_EQ(p["zero"], -2.0);
  EXPECT_DOUBLE_EQ(p["step"].get<double>(), 6.0 / 65534);
  EXPECT_EQ(p["packed"], encoded(std::string("\0\0\xff\xff\xfe\xff", 6)));
}

TEST(Packed, AConstantOrAnEmptySignalHasNoRangeAndDoesNoHarm) {
  EXPECT_EQ(packed(std::vector{3.0, 3.0})["packed"], encoded(std::string(4, '\0')));
  EXPECT_EQ(packed(std::vector{std::nan("")})["zero"], 0.0);
  EXPECT_EQ(packed(std::vector<double>{})["packed"], "");
}

TEST(Packed, ASignalComesBackToHalfAStep) {
  Rng rng(3);
  std::vector<double> values(1000);
  for (double& value : values) value = rng.uniform(-7.0, 3.0);
  values[17] = values[900] = NAN;
  const json p = packed(values);
  const std::vector<double> back = unpacked(p);
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(std::isnan(back[i]), std::isnan(values[i]));
    if (std::isnan(values[i])) continue;
    EXPECT_NEAR(back[i], values[i], 0.5001 * p["step"].get<double>());
  }
}

TEST(Packed, ARangeThatOverflowsDoesNotStopTheReport) {
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ(unpacked(packed(std::vector{-huge, huge})).size(), 2u);
}

}  // namespace
}  // namespace kinfer::report
