// SPDX-License-Identifier: Apache-2.0
// report.html from evidence: complete, well formed, with escaped names and notes, and limited in size.
#include "kinfer/report/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/frames_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::test {
namespace {

using nlohmann::ordered_json;
using report::report_html;
using report::report_of_file;

std::string calibration_report(const Calibration& c) {
  return report_html(calibration_evidence(c, rich_provenance()));
}

std::string identification_report(const Identification& i) {
  return report_html(identification_evidence(i, rich_provenance()));
}

/// A machine whose log was `rows` samples of `sensors` sensors, all signals noise-like.
Identification long_identification(std::size_t rows, std::size_t sensors) {
  Identification found;
  found.root = "s0";
  std::vector<double> samples(rows);
  for (std::size_t i = 0; i < rows; ++i) samples[i] = 3.0 * std::sin(1.7 * static_cast<double>(i * i % 1000003));
  const Binning bins = binning(rows, 1000);
  const Envelope thin = envelope(samples, bins);
  for (std::size_t i = 0; i < bins.count(); ++i) found.motion.time.push_back(static_cast<double>(i) * 3.6);
  for (std::size_t s = 0; s < sensors; ++s) {
    found.order.sensors.push_back("s" + std::to_string(s));
    if (s == 0) continue;
    JointEstimate joint;
    joint.parent = "s" + std::to_string(s - 1), joint.child = "s" + std::to_string(s);
    found.joints.push_back(joint);
    for (const TraceQuantity quantity : {TraceQuantity::acceleration, TraceQuantity::angular_velocity})
      found.motion.traces.push_back({.sensor = joint.child,
                                     .quantity = quantity,
                                     .measured = {thin, thin, thin},
                                     .predicted = {thin, thin, thin},
                                     .residual = {thin, thin, thin}});
  }
  found.motion.trajectory.time = std::vector<double>(600, 0.0);
  found.motion.trajectory.root = {{1, 0, 0, 0}};
  found.motion.trajectory.q = MatrixXd::Zero(0, 600);
  return found;
}

/// Opened elements that are not closed, or closed ones that were not opened; scripts and styles are skipped.
std::vector<std::string> unbalanced(const std::string& html) {
  static const std::set<std::string> empty{"meta", "link", "input", "br", "!doctype"};
  std::vector<std::string> open, wrong;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const bool closing = html[at + 1] == '/';
    std::string name;
    for (std::size_t k = at + (closing ? 2 : 1); std::isalnum(static_cast<unsigned char>(html[k])) || html[k] == '!';
         ++k)
      name += html[k];
    const std::size_t end = html.find('>', at);
    if (name.empty() || empty.contains(name) || html[end - 1] == '/') continue;
    if (!closing) {
      open.push_back(name);
      if (name == "script" || name == "style") at = html.find("</" + name, at) - 1;
    } else if (!open.empty() && open.back() == name) {
      open.pop_back();
    } else {
      wrong.push_back(name);
    }
  }
  wrong.insert(wrong.end(), open.begin(), open.end());
  return wrong;
}

TEST(Report, EveryElementThatIsOpenedIsClosed) {
  EXPECT_EQ(unbalanced(calibration_report(rich_calibration())), std::vector<std::string>{});
  EXPECT_EQ(unbalanced(identification_report(rich_identification())), std::vector<std::string>{});
  EXPECT_EQ(unbalanced(identification_report(long_identification(2000, 3))), std::vector<std::string>{});
}

TEST(Report, FromItsFileIsThatOfTheValues) {
  const CalibrationEvidence calibration = calibration_evidence(rich_calibration(), rich_provenance());
  EXPECT_EQ(report_of_file(format_calibration_evidence(calibration)).value(), report_html(calibration));
  const IdentificationEvidence identification = identification_evidence(rich_identification(), rich_provenance());
  EXPECT_EQ(report_of_file(format_identification_evidence(identification)).value(), report_html(identification));
}

TEST(Report, NamesAndNotesAreEscaped) {
  const std::string html = calibration_report(rich_calibration());
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("<b>bold"), std::string::npos);
  EXPECT_NE(html.find("&lt;b&gt;bold &amp; brave"), std::string::npos);
  EXPECT_NE(html.find("two &lt;joints&gt;"), std::string::npos);
}

/// Replaces every string of the evidence but names that must be known.
void make_hostile(ordered_json& json, const std::string& key = "") {
  static const std::set<std::string> names{"format",   "kind",      "type",     "unit",       "severity", "stop",
                                           "quantity", "usability", "frame",    "remedy",     "decision", "missing",
                                           "engine",   "start",     "relation", "measurement"};
  if (json.is_string() && !names.contains(key)) {
    json = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\" onclick=\"alert(3)";
  } else if (json.is_structured()) {
    for (auto& [name, member] : json.items()) make_hostile(member, json.is_object() ? name : key);
  }
}

TEST(Report, NoTextOfTheEvidenceBecomesMarkup) {
  for (ordered_json json : {calibration_json(calibration_evidence(rich_calibration(), rich_provenance())),
                            identification_json(identification_evidence(rich_identification(), rich_provenance()))}) {
    const ordered_json reason = json.value("reason", ordered_json()),
                       undetermined = json.value("undetermined", ordered_json());
    make_hostile(json);
    if (!reason.is_null()) json["reason"] = reason, json["undetermined"] = undetermined;  // enumerators
    const auto html = report_of_file(json.dump());
    ASSERT_TRUE(html) << html.error().what;
    EXPECT_EQ(html->find("<script>alert"), std::string::npos);
    EXPECT_EQ(html->find("<img"), std::string::npos);
    EXPECT_EQ(html->substr(0, html->find("<script type=\"application/json\"")).find("\" onclick"), std::string::npos);
    EXPECT_EQ(unbalanced(*html), std::vector<std::string>{});
  }
}

TEST(Report, NothingIsFetchedFromAnywhere) {
  const std::string html = calibration_report(rich_calibration());
  EXPECT_EQ(html.find("<script src"), std::string::npos);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST(Report, HoldsTheLicencesOfItsScripts) {
  for (const std::string& html : {calibration_report(rich_calibration()), identification_report(rich_identification())})
    EXPECT_NE(html.find("Third-party notices"), std::string::npos);
}

TEST(Report, EverySectionIsLinkedOnce) {
  const std::string html = identification_report(rich_identification());
  std::set<std::string> ids;
  const std::regex section("<section id=\"([^\"]*)\"");
  for (auto at = std::sregex_iterator(html.begin(), html.end(), section); at != std::sregex_iterator(); ++at) {
    EXPECT_TRUE(ids.insert((*at)[1]).second) << (*at)[1];
    EXPECT_NE(html.find("<a href=\"#" + (*at)[1].str() + "\">"), std::string::npos);
  }
  EXPECT_EQ(ids.size(), 11u);
}

TEST(Report, WithoutPosesRowsOrParametersThereIsStillAReport) {
  Calibration empty;
  empty.usability = Usability::do_not_use;
  empty.reason = CalibrationReason::no_improvement;
  EXPECT_NE(calibration_report(empty).find("class=\"chip bad\""), std::string::npos);
  EXPECT_NE(identification_report({}).find("0&nbsp;joints found"), std::string::npos);
}

TEST(Report, OfTwoSensorsThereIsOneToo) {
  Identification two = rich_identification();
  two.order.margin.reset();
  const auto html = report_of_file(format_identification_evidence(identification_evidence(two, {})));
  ASSERT_TRUE(html) << html.error().what;
  EXPECT_NE(html->find("no other order is possible"), std::string::npos);
}

TEST(Report, AnHourOfSixSensorsStaysBelowFiveMegabytes) {
  const std::string html = identification_report(long_identification(720000, 6));
  EXPECT_LT(html.size(), 5'000'000u);
  RecordProperty("bytes", static_cast<int>(html.size()));
}

TEST(Report, OfAnotherKindThereIsNone) {
  EXPECT_EQ(report_of_file("[]").error().what, "evidence.json: not a JSON object");
  EXPECT_EQ(report_of_file(format_frames_evidence(frames_evidence(rich_frames()))).error().what,
            "evidence.json: there is no report for kind 'frames'");
  EXPECT_EQ(report_of_file("{\"kind\": \"calibrate\", \"verdict\": \"x\"}").error().what,
            "evidence.json: robot: missing");
}

}  // namespace
}  // namespace kinfer::test
