// SPDX-License-Identifier: Apache-2.0
// report.html from evidence: complete, well formed, with escaped names and notes, and limited in size.
#include "kinfer/report/report.hpp"
#include "kinfer/report/parts/html.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "kinfer/evidence/calibration.hpp"
#include "kinfer/evidence/identification.hpp"
#include "kinfer/evidence/provenance.hpp"
#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/io/evidence/identification_json.hpp"
#include "support/robots.hpp"

namespace kinfer::test {
namespace {

Chain two_joints() {
  Chain chain;
  chain.name = "two <joints> & \"more\"";
  chain.joints = {mdh_joint(0.0, 0.0, 0.4, -170, 170, -1), mdh_joint(0.3, -90.0, 0.0, -90, 90, 0)};
  return chain;
}

Calibration small_calibration() {
  Calibration c;
  c.estimate.chain = two_joints();
  c.plot_data.nominal = c.plot_data.before = two_joints();
  c.plot_data.joints = MatrixXd::Constant(2, 3, 0.2);
  for (int row = 0; row < 3; ++row) {
    c.rows.push_back({row, 1e-3, 1e-4, 1e-4, true});
    c.plot_data.rows.push_back({Vec3(0.3, 0.1, row), Vec3(1e-3, 0, 0), Vec3(1e-4, 0, 0), 5e-5});
  }
  c.plot_data.workspace = {{Vec3(1, 2, 3), 1e-4}, {Vec3(2, 2, 1), 2e-4}};
  c.before.position.holdout = {1e-3, 1e-3, 1e-4, 2e-3, 3};
  c.after.position.holdout = {1e-4, 1e-4, 1e-5, 2e-4, 3};
  c.estimate.values = {{"a2", Quantity::length, 0.3, 0.3001, 1e-5, true},
                       {"theta1", Quantity::angle, 0, 0, 1e-3, false}};
  c.estimate.covariance = MatrixXd::Identity(2, 2);
  c.estimate.identifiability.singular_values = VectorXd::LinSpaced(2, 10.0, 0.1);
  c.estimate.outliers = {{.row = 2, .line = 4, .reasons = {{MeasurementKind::point, 1e-2, 80.0}}, .sigmas = 80.0}};
  c.estimate.identifiability.undetermined = {
      {Undetermined::confounded, {"</script><script>alert(1)</script>", "<b>bold & brave</b>"}}};
  c.recommendations = {{CalibrationAdviceKind::keep_verification_poses}};
  return c;
}

std::string calibration_report(const Calibration& c) {
  return report_html(format_calibration_evidence(c, {})).value();
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

TEST(Html, ProseKeepsUnitsWithTheirNumbersAndSetsCallsAsCode) {
  EXPECT_EQ(html::prose("± 5 mm in J1 12 of a < b"), "±&nbsp;5&nbsp;mm in J1 12&nbsp;of a &lt; b");
  EXPECT_EQ(html::prose("as kinfer plan --data chooses, or kinfer verify."),
            "as <code>kinfer plan --data</code> chooses, or <code>kinfer verify</code>.");
}

TEST(Report, EveryElementThatIsOpenedIsClosed) {
  EXPECT_EQ(unbalanced(calibration_report(small_calibration())), std::vector<std::string>{});
  EXPECT_EQ(unbalanced(report_html(format_identification_evidence(long_identification(2000, 3), {})).value()),
            std::vector<std::string>{});
}

TEST(Report, NamesAndNotesAreEscaped) {
  const std::string html = calibration_report(small_calibration());
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(html.find("<b>bold"), std::string::npos);
  EXPECT_NE(html.find("&lt;b&gt;bold &amp; brave"), std::string::npos);
  EXPECT_NE(html.find("two &lt;joints&gt;"), std::string::npos);
}

TEST(Report, TheSameEvidenceGivesTheSameBytes) {
  EXPECT_EQ(calibration_report(small_calibration()), calibration_report(small_calibration()));
}

TEST(Report, NothingIsFetchedFromAnywhere) {
  const std::string html = calibration_report(small_calibration());
  EXPECT_EQ(html.find("<script src"), std::string::npos);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST(Report, WithoutPosesRowsOrParametersThereIsStillAReport) {
  Calibration empty;
  empty.usability = Usability::do_not_use;
  empty.reason = CalibrationReason::no_improvement;
  const auto html = report_html(format_calibration_evidence(empty, {}));
  ASSERT_TRUE(html) << html.error().what;
  EXPECT_NE(html->find("class=\"chip bad\""), std::string::npos);
  EXPECT_TRUE(report_html(format_identification_evidence(Identification{}, {})));
}

TEST(Report, AnHourOfSixSensorsStaysBelowFiveMegabytes) {
  const std::string html = report_html(format_identification_evidence(long_identification(720000, 6), {})).value();
  EXPECT_LT(html.size(), 5'000'000u);
  RecordProperty("bytes", static_cast<int>(html.size()));
}

TEST(Report, InvalidEvidenceIsAnErrorOfOneSentence) {
  EXPECT_EQ(report_html("[]").error().what, "evidence.json: not a JSON object");
  EXPECT_EQ(report_html("{\"kind\": \"frames\"}").error().what, "evidence.json: there is no report for kind 'frames'");
  const auto lacking = report_html("{\"kind\": \"calibrate\", \"verdict\": \"x\"}");
  ASSERT_FALSE(lacking);
  EXPECT_EQ(lacking.error().what.find("evidence.json: not in kinfer's format"), 0u);
}

}  // namespace
}  // namespace kinfer::test
