// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/parts/packed.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kinfer::pages {
namespace {

using nlohmann::json;

std::string encoded(const std::string& text) {
  return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

TEST(Packed, Base64IsThatOfTheRfc) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Packed, NumbersSpanAllCodesAndAMissingOneIsTheLastCode) {
  const json p = packed(json::array({-2.0, nullptr, 4.0}));
  EXPECT_EQ(p["zero"], -2.0);
  EXPECT_DOUBLE_EQ(p["step"].get<double>(), 6.0 / 65534);
  EXPECT_EQ(p["packed"], encoded(std::string("\0\0\xff\xff\xfe\xff", 6)));
}

TEST(Packed, AConstantOrAnEmptySignalHasNoRangeAndDoesNoHarm) {
  EXPECT_EQ(packed(json::array({3.0, 3.0}))["packed"], encoded(std::string(4, '\0')));
  EXPECT_EQ(packed(json::array({nullptr}))["zero"], 0.0);
  EXPECT_EQ(packed(json::array())["packed"], "");
}

}  // namespace
}  // namespace kinfer::pages
