#include "kinfer/report/packed.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kinfer::pages {
namespace {

using nlohmann::json;

std::string encoded(const std::string& text) {
  return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

TEST(Packed, base64_is_that_of_the_rfc) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
}

TEST(Packed, numbers_span_all_steps_and_a_missing_one_is_the_last_code) {
  const json p = packed(json::array({-2.0, nullptr, 4.0}));
  EXPECT_EQ(p["zero"], -2.0);
  EXPECT_DOUBLE_EQ(p["step"].get<double>(), 6.0 / 65534);
  EXPECT_EQ(p["packed"], encoded(std::string("\0\0\xff\xff\xfe\xff", 6)));
}

TEST(Packed, a_constant_or_an_empty_signal_has_no_range_and_does_no_harm) {
  EXPECT_EQ(packed(json::array({3.0, 3.0}))["packed"], encoded(std::string(4, '\0')));
  EXPECT_EQ(packed(json::array({nullptr}))["zero"], 0.0);
  EXPECT_EQ(packed(json::array())["packed"], "");
}

}  // namespace
}  // namespace kinfer::pages
