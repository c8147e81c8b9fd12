// SPDX-License-Identifier: Apache-2.0
// The data of the page's scripts: what web/src/evidence.ts declares, and no more.
#include "kinfer/report/parts/script_data.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::report {
namespace {

using nlohmann::json;

std::set<std::string> keys_of(const json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

CalibrationEvidence calibration() {
  return calibration_evidence(test::rich_calibration(), test::rich_provenance());
}

IdentificationEvidence identification() {
  return identification_evidence(test::rich_identification(), test::rich_provenance());
}

json data_of_calibration() {
  return json::parse(script_data(calibration()));
}

json data_of_identification() {
  return json::parse(script_data(identification()));
}

TEST(ScriptData, OfACalibrationHoldsWhatIsDrawn) {
  const json data = data_of_calibration();
  EXPECT_EQ(keys_of(data), (std::set<std::string>{"kind", "outliers", "picture", "rows"}));
  EXPECT_EQ(keys_of(data["rows"]), (std::set<std::string>{"before", "after", "held_out"}));
  for (const char* key : {"chains", "q", "measured", "off_before", "off_after", "predicted", "workspace"})
    EXPECT_TRUE(data["picture"].contains(key)) << key;
}

TEST(ScriptData, EveryListOfRowsHasOneEntryForEachRow) {
  const json data = data_of_calibration();
  const std::size_t rows = calibration().rows.size();
  for (const char* key : {"before", "after", "held_out"}) EXPECT_EQ(data["rows"][key].size(), rows) << key;
  for (const char* key : {"q", "measured", "off_before", "off_after", "predicted"})
    EXPECT_EQ(data["picture"][key].size(), rows) << key;
}

TEST(ScriptData, ErrorsAreRoundedToATenthOfAMicrometre) {
  CalibrationEvidence e = calibration();
  e.rows[1].before = 1.23456789e-3;
  const json rows = json::parse(script_data(e))["rows"];
  EXPECT_EQ(rows["before"][1], 1.2346e-3);
  EXPECT_TRUE(rows["before"].back().is_null());  // not measured
  EXPECT_EQ(rows["held_out"][0], true);
  EXPECT_EQ(rows["held_out"][1], false);
}

TEST(ScriptData, OfAnIdentificationHoldsWhatIsDrawn) {
  const json data = data_of_identification();
  EXPECT_EQ(keys_of(data), (std::set<std::string>{"kind", "root", "joints", "chain", "order", "motion"}));
  for (const char* key : {"time", "held_out", "traces", "playback"}) EXPECT_TRUE(data["motion"].contains(key)) << key;
  EXPECT_TRUE(data["joints"][1]["axis_in_parent"].is_null());  // spherical
  EXPECT_EQ(data["joints"][0]["not_identifiable_in_child"].size(), 1u);
}

TEST(ScriptData, SignalsArePackedAndTheirNamesKept) {
  const json traces = data_of_identification()["motion"]["traces"];
  ASSERT_EQ(traces.size(), 2u);
  EXPECT_EQ(traces[0]["quantity"], "acceleration");
  EXPECT_EQ(traces[0]["unit"], "m/s^2");
  EXPECT_EQ(traces[0]["frame"], "ground");
  EXPECT_EQ(traces[1]["quantity"], "rate");
  EXPECT_EQ(traces[1]["frame"], "sensor");
  for (const char* signal : {"measured", "predicted", "residual"})
    for (const json& axis : traces[1][signal])
      for (const char* side : {"low", "high"}) {
        EXPECT_EQ(keys_of(axis[side]), (std::set<std::string>{"packed", "step", "zero"}));
        EXPECT_EQ(axis[side]["packed"].get<std::string>().size(), 32u);  // 12 codes of 2 bytes in base64
      }
}

TEST(ScriptData, IsTheSameAfterReadingTheFile) {
  const CalibrationEvidence c = calibration();
  EXPECT_EQ(script_data(read_calibration_evidence(format_calibration_evidence(c)).value()), script_data(c));
  const IdentificationEvidence i = identification();
  EXPECT_EQ(script_data(read_identification_evidence(format_identification_evidence(i)).value()), script_data(i));
}

TEST(ScriptData, EscapedForAScriptItCannotCloseItAndKeepsItsMeaning) {
  const std::string data = script_data(calibration()), safe = escape_for_script(data);
  EXPECT_EQ(safe.find('<'), std::string::npos);
  EXPECT_EQ(json::parse(safe), json::parse(data));
  EXPECT_EQ(escape_for_script("</script>"), "\\u003c/script>");
}

}  // namespace
}  // namespace kinfer::report
