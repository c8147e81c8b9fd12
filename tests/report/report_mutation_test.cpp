// SPDX-License-Identifier: Apache-2.0
// Changed evidence files: each gives a report or an error of one sentence, never a crash.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "kinfer/base/rng.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "kinfer/report/report.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::test {
namespace {

using nlohmann::ordered_json;
using report::report_of_file;

/// Changes, removes or doubles one value somewhere in the evidence.
void mutate(ordered_json& json, Rng& rng) {
  const auto pick = [&](std::size_t n) {
    return std::min(n - 1, static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(n))));
  };
  ordered_json* at = &json;
  while (at->is_structured() && !at->empty()) {
    const auto child = std::next(at->begin(), static_cast<std::ptrdiff_t>(pick(at->size())));
    if (child->is_structured() && !child->empty() && rng.uniform(0.0, 1.0) < 0.9) {
      at = &*child;
      continue;
    }
    static const std::vector<ordered_json> others{nullptr,
                                                  true,
                                                  -1,
                                                  0,
                                                  7,
                                                  1e308,
                                                  -1e308,
                                                  1e17,
                                                  1e99,
                                                  -1e99,
                                                  1e-300,
                                                  5e-324,
                                                  "",
                                                  "x",
                                                  3.5,
                                                  2147483647,
                                                  ordered_json::array(),
                                                  ordered_json::object()};
    if (const std::size_t what = pick(4); what == 0) {
      at->erase(child);
    } else if (what == 1 && at->is_array()) {
      at->push_back(ordered_json(*child));
    } else {
      *child = others[pick(others.size())];
    }
    return;
  }
}

/// Coordinates and numbers of the page that are none.
bool draws_numbers(const std::string& html) {
  static const std::array<std::string, 2> none{"nan", "inf"};
  static const std::string before = " \"ML-,(", after = " \"ML,<)%";
  for (const std::string& word : none)
    for (std::size_t at = html.find(word); at != std::string::npos; at = html.find(word, at + 1)) {
      const bool begins = at > 0 && before.find(html[at - 1]) != std::string::npos;
      const bool ends = at + 3 < html.size() && after.find(html[at + 3]) != std::string::npos;
      if (begins && ends) return false;
    }
  return true;
}

TEST(Report, AMutatedFileGivesAReportOrOneSentence) {
  const std::array originals{calibration_json(calibration_evidence(rich_calibration(), rich_provenance())),
                             identification_json(identification_evidence(rich_identification(), rich_provenance()))};
  int reports = 0;
  for (int seed = 0; seed < 1000; ++seed) {
    Rng rng(static_cast<std::uint64_t>(seed));
    ordered_json json = originals[static_cast<std::size_t>(seed % 2)];
    for (int k = 0; k <= seed % 3; ++k) mutate(json, rng);
    const auto html = report_of_file(json.dump());
    reports += html ? 1 : 0;
    EXPECT_TRUE(html || html.error().what.starts_with("evidence.json: "));
    if (html) EXPECT_TRUE(draws_numbers(*html)) << seed;
  }
  EXPECT_GT(reports, 100);
  EXPECT_LT(reports, 900);
}

TEST(Report, ATextWithChangedBytesGivesAReportOrOneSentence) {
  const std::string original = format_calibration_evidence(calibration_evidence(rich_calibration(), {}));
  for (int seed = 0; seed < 1000; ++seed) {
    Rng rng(static_cast<std::uint64_t>(seed));
    std::string text = original;
    for (int k = 0; k < 3; ++k)
      text[static_cast<std::size_t>(rng.uniform(0.0, static_cast<double>(text.size() - 1)))] =
          static_cast<char>(rng.uniform(-128.0, 127.0));
    const auto html = report_of_file(text);
    EXPECT_TRUE(html || html.error().what.starts_with("evidence.json: "));
  }
}

}  // namespace
}  // namespace kinfer::test
