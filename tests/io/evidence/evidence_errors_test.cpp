// SPDX-License-Identifier: Apache-2.0
// What is wrong with an evidence.json is said with the path of the value.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/evidence_file.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::test {
namespace {

using nlohmann::ordered_json;
using Edit = std::function<void(ordered_json&)>;

std::string error_of(ordered_json json, const Edit& edit) {
  edit(json);
  const auto read = read_evidence(json.dump());
  return read ? "no error" : read.error().what;
}

std::string calibration_error(const Edit& edit) {
  return error_of(calibration_json(calibration_evidence(rich_calibration(), rich_provenance())), edit);
}

std::string identification_error(const Edit& edit) {
  return error_of(identification_json(identification_evidence(rich_identification(), rich_provenance())), edit);
}

TEST(EvidenceErrors, NameThePathOfAValueOfAnotherType) {
  EXPECT_EQ(identification_error([](auto& j) { j["joints"][1]["sd"]["slide_m"] = "long"; }),
            "evidence.json: joints[1].sd.slide_m: expected a number");
  EXPECT_EQ(calibration_error([](auto& j) { j["after"]["train"]["n"] = 2.5; }),
            "evidence.json: after.train.n: expected a whole number");
  EXPECT_EQ(calibration_error([](auto& j) { j["outliers"][0]["row"] = 3000000000; }),
            "evidence.json: outliers[0].row: expected a whole number");
  EXPECT_EQ(calibration_error([](auto& j) { j["provenance"]["seed"] = -1; }),
            "evidence.json: provenance.seed: expected a whole number");
  EXPECT_EQ(calibration_error([](auto& j) { j["use"] = "yes"; }), "evidence.json: use: expected true or false");
  EXPECT_EQ(calibration_error([](auto& j) { j["robot"] = 7; }), "evidence.json: robot: expected a text");
  EXPECT_EQ(calibration_error([](auto& j) { j["notes"] = "none"; }), "evidence.json: notes: expected a list");
  EXPECT_EQ(calibration_error([](auto& j) { j["notes"] = {"a", 1}; }), "evidence.json: notes[1]: expected a text");
  EXPECT_EQ(calibration_error([](auto& j) { j["model"] = 1; }), "evidence.json: model: expected an object");
  EXPECT_EQ(calibration_error([](auto& j) { j["rows"] = 1; }), "evidence.json: rows: expected an object");
  EXPECT_EQ(calibration_error([](auto& j) { j["provenance"]["options"] = 1; }),
            "evidence.json: provenance.options: expected an object");
  EXPECT_EQ(identification_error([](auto& j) { j["fit"]["holdout"]["s<1>"]["total"] = true; }),
            "evidence.json: fit.holdout.s<1>.total: expected a number");
}

TEST(EvidenceErrors, NameAMissingKey) {
  EXPECT_EQ(calibration_error([](auto& j) { j.erase("after"); }), "evidence.json: after: missing");
  EXPECT_EQ(identification_error([](auto& j) { j["joints"][0]["sd"].erase("slide_m"); }),
            "evidence.json: joints[0].sd.slide_m: missing");
  EXPECT_EQ(identification_error([](auto& j) { j["dh"][0].erase("sd"); }), "evidence.json: dh[0].sd: missing");
  EXPECT_EQ(calibration_error([](auto& j) { j["provenance"].erase("options"); }),
            "evidence.json: provenance.options: missing");
}

TEST(EvidenceErrors, NameAnUnknownEnumerator) {
  EXPECT_EQ(identification_error([](auto& j) { j["joints"][0]["type"] = "hinge"; }),
            "evidence.json: joints[0].type: unknown name");
  EXPECT_EQ(calibration_error([](auto& j) { j["findings"][0]["kind"] = "bad_luck"; }),
            "evidence.json: findings[0].kind: unknown name");
  EXPECT_EQ(calibration_error([](auto& j) { j["parameters"][0]["unit"] = "furlong"; }),
            "evidence.json: parameters[0].unit: unknown name");
  EXPECT_EQ(calibration_error([](auto& j) { j["outliers"][0]["measurements"][1]["kind"] = "smell"; }),
            "evidence.json: outliers[0].measurements[1].kind: unknown name");
  EXPECT_EQ(calibration_error([](auto& j) { j["next"][1]["kind"] = "rest"; }),
            "evidence.json: next[1].kind: unknown name");
  EXPECT_EQ(identification_error([](auto& j) { j["joints"][0]["unobservable"][0]["remedy"] = "prayer"; }),
            "evidence.json: joints[0].unobservable[0].remedy: unknown name");
  EXPECT_EQ(calibration_error([](auto& j) { j["search"]["stop"] = 1; }), "evidence.json: search.stop: unknown name");
}

TEST(EvidenceErrors, NameListsOfTheWrongLength) {
  EXPECT_EQ(identification_error([](auto& j) {
              j["joints"][0]["point_in_child"] = {1, 2};
            }),
            "evidence.json: joints[0].point_in_child: expected a list of 3");
  EXPECT_EQ(calibration_error([](auto& j) { j["rows"]["after"].erase(0); }),
            "evidence.json: rows.after: expected 6 values");
  EXPECT_EQ(calibration_error([](auto& j) { j["covariance"][1].erase(0); }),
            "evidence.json: covariance: expected lists of equal length");
  EXPECT_EQ(identification_error([](auto& j) { j["motion"]["traces"][0]["measured"][1]["low"].erase(0); }),
            "evidence.json: motion.traces: expected as many values as times");
  EXPECT_EQ(identification_error([](auto& j) { j["search"]["median"].erase(0); }),
            "evidence.json: search.median: expected one list for each of best");
  EXPECT_EQ(identification_error([](auto& j) { j["chain"]["joints"][0]["couplings"] = {{1}}; }),
            "evidence.json: chain.joints[0].couplings[0]: expected a list of 2");
}

TEST(EvidenceErrors, NameAChainThatIsNoTree) {
  EXPECT_EQ(calibration_error([](auto& j) { j["picture"]["chains"]["before"]["joints"][1]["parent"] = 1; }),
            "evidence.json: picture.chains.before.joints: the parent of a joint must come before it");
  EXPECT_EQ(identification_error([](auto& j) { j["chain"]["tip"] = 1; }), "evidence.json: chain.tip: no such joint");
}

TEST(EvidenceErrors, NameFactsThatAreNone) {
  EXPECT_EQ(calibration_error([](auto& j) {
              j["findings"][0]["values"]["extra"] = {{"x", 1}};
            }),
            "evidence.json: findings[0].values.extra: expected a number, a text or a list of them");
  EXPECT_EQ(calibration_error([](auto& j) { j["findings"][0]["values"] = 1; }),
            "evidence.json: findings[0].values: expected an object");
}

TEST(EvidenceErrors, NameAnotherFormatOrKind) {
  EXPECT_EQ(calibration_error([](auto& j) { j["format"] = "kinfer-evidence/2"; }),
            "evidence.json: format: expected \"kinfer-evidence/1\"");
  EXPECT_EQ(calibration_error([](auto& j) { j["kind"] = "bake"; }), "evidence.json: there is no kind 'bake'");
  EXPECT_EQ(read_calibration_evidence("{\"kind\": \"identify\"}").error().what,
            "evidence.json: kind: expected \"calibrate\"");
}

TEST(EvidenceErrors, TextThatIsNoObjectIsToldInOneSentence) {
  for (const char* text : {"", "[]", "{", "null", "{\"kind\": \"calibrate\"} x"})
    EXPECT_EQ(read_evidence(text).error().what, "evidence.json: not a JSON object") << text;
}

}  // namespace
}  // namespace kinfer::test
