// SPDX-License-Identifier: Apache-2.0
#include "kinfer/report/calibrate/page.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "kinfer/io/evidence/calibration_json.hpp"
#include "kinfer/report/calibrate/figures.hpp"
#include "kinfer/report/calibrate/sections.hpp"
#include "support/html_text.hpp"
#include "support/rich_evidence.hpp"

namespace kinfer::report {
namespace {

using test::count_of;
using test::shows;

CalibrationEvidence rich() {
  return calibration_evidence(test::rich_calibration(), test::rich_provenance());
}

TEST(CalibrationHeadline, ComparesHeldOutRowsWhereThereAreAny) {
  CalibrationEvidence e = rich();
  Headline h = headline(e);
  EXPECT_TRUE(h.held_out);
  EXPECT_DOUBLE_EQ(h.mean_before, 1.2);
  EXPECT_DOUBLE_EQ(h.mean_after, 0.12);
  EXPECT_EQ(h.unit, "mm");
  EXPECT_EQ(h.what, "the tool");
  e.after.position.holdout.n = 0;
  h = headline(e);
  EXPECT_FALSE(h.held_out);
  EXPECT_DOUBLE_EQ(h.mean_before, 1.0);
}

TEST(CalibrationHeadline, NamesWhatTheErrorsReferTo) {
  CalibrationEvidence e = rich();
  e.measured = "distance", e.measurement = kind_of<DistanceMeasurement>;
  EXPECT_EQ(headline(e).what, "the distance");
  e.after.position = {};
  EXPECT_EQ(headline(e).what, "the tool's orientation");
  EXPECT_EQ(headline(e).unit, "°");
  EXPECT_NEAR(headline(e).mean_after, 2e-4 * 180.0 / M_PI, 1e-12);
}

TEST(CalibrationPage, TellsWhatTheResidualsAre) {
  CalibrationEvidence e = rich();
  EXPECT_TRUE(shows(calibration_page(e).first, "mostly the instrument's noise"));
  e.chi2_per_n = 16.0;
  EXPECT_TRUE(shows(calibration_page(e).first, "4.00 times the instrument's noise"));
  e.chi2_per_n = std::nullopt;
  EXPECT_TRUE(shows(calibration_page(e).first, "No instrument was stated"));
}

TEST(CalibrationPage, CountsWhatIsNotDeterminedAndWhatWasLeftOut) {
  CalibrationEvidence e = rich();
  EXPECT_TRUE(shows(calibration_page(e).first, "1 of 4 parameters are not determined"));
  EXPECT_TRUE(shows(calibration_page(e).first, "One row was</a> rejected"));
  e.outliers.push_back({{.row = 3, .line = 5}, "far"});
  e.parameters[2].identifiable = true;
  EXPECT_TRUE(shows(calibration_page(e).first, "The data determine every parameter."));
  EXPECT_TRUE(shows(calibration_page(e).first, "2 rows were</a> rejected"));
}

TEST(CalibrationPage, EverySectionHasItsPlace) {
  std::vector<std::string> ids;
  for (const html::Section& section : calibration_page(rich()).sections) ids.push_back(section.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"errors", "parameters-section", "uncertainty", "model-section", "doubts",
                                           "search", "next", "words", "repeat", "notices"}));
}

TEST(CalibrationErrors, TablesShowOnlyWhatWasMeasured) {
  CalibrationEvidence e = rich();
  const std::string body = errors_section(e).body;
  EXPECT_TRUE(shows(body, "id=\"orientation-errors\""));
  EXPECT_TRUE(shows(body, "the same with gross errors"));
  e.after.orientation.train.n = 0;
  e.gross_error_rows.clear();
  e.nominal.position.holdout.n = 0;
  const std::string less = errors_section(e).body;
  EXPECT_FALSE(shows(less, "orientation-errors"));
  EXPECT_FALSE(shows(less, "the same with gross errors"));
  EXPECT_FALSE(shows(less, "as given, not fitted"));
}

TEST(CalibrationErrors, AreShownInMillimetresAndCopiedExactly) {
  EXPECT_TRUE(shows(errors_section(rich()).body, "data-v=\"0.12\">0.1200</td>"));
}

TEST(CalibrationErrors, EachMeasuredRowIsADotThatKnowsItsRow) {
  const std::string svg = errors_per_pose(rich());
  EXPECT_EQ(count_of(svg, "data-row="), 5u);           // the last row has no error
  EXPECT_EQ(count_of(svg, "class=\"fill-bad\""), 2u);  // the outlier, and the legend
  EXPECT_EQ(count_of(svg, "class=\"ring-after\""), 3u);
}

TEST(CalibrationErrors, TheHistogramCountsEveryInlierOnce) {
  CalibrationEvidence e = rich();
  e.outliers.clear();
  e.rows.clear();
  for (int row = 0; row < 60; ++row) e.rows.push_back({row, 1e-3 + 1e-5 * row, 1e-4, 1e-4, true});
  const std::string svg = error_histogram(e);
  int counted = 0;
  for (std::size_t at = svg.find("<title>before: "); at != std::string::npos; at = svg.find("<title>before: ", at + 1))
    counted += std::stoi(svg.substr(at + 15));
  EXPECT_EQ(counted, 60);
  EXPECT_TRUE(shows(svg, "after: 60 poses"));
}

TEST(CalibrationErrors, WithoutRowsThereIsNoFigure) {
  CalibrationEvidence e = rich();
  e.rows.clear();
  EXPECT_EQ(error_histogram(e), "");
  EXPECT_EQ(errors_per_pose(e), "");
  EXPECT_TRUE(std::isnan(error_percentile_95(e)));
}

TEST(CalibrationErrors, NegativeOrHugeErrorsFallIntoTheOuterBins) {
  CalibrationEvidence e = rich();
  e.rows[0].after = -1.0, e.rows[1].after = 1e300;
  EXPECT_FALSE(error_histogram(e).empty());
}

TEST(CalibrationParameters, AreShownInTheirUnits) {
  const std::string body = parameters_section(rich()).body;
  EXPECT_TRUE(shows(body, "<td>mm</td>"));
  EXPECT_TRUE(shows(body, "<td>°</td>"));
  EXPECT_TRUE(shows(body, "<td>rad/(N m)</td>"));
  EXPECT_TRUE(shows(body, "<td>placement</td>"));
  EXPECT_TRUE(shows(body, "not determined"));
  EXPECT_TRUE(shows(body, "<b>theta&lt;1&gt;</b>"));
}

TEST(CalibrationUncertainty, ConfoundedParametersAreListed) {
  CalibrationEvidence e = rich();
  EXPECT_TRUE(shows(uncertainty_section(e).body, "d&lt;3&gt;"));
  e.undetermined.clear();
  EXPECT_TRUE(shows(uncertainty_section(e).body, "The data determine every combination of parameters."));
}

TEST(CalibrationUncertainty, CorrelationIsThatOfTheCovariance) {
  CalibrationEvidence e = rich();
  e.covariance = (MatrixXd(4, 4) << 4, -1.8, 0, 0, -1.8, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1).finished();
  EXPECT_TRUE(shows(correlation_map(e), "a2 and base_rz: -0.90"));
  e.covariance.resize(3, 3);
  EXPECT_EQ(correlation_map(e), "");
}

TEST(CalibrationUncertainty, TheMapHasTheMostUncertainPlaceInTheHottestClass) {
  const std::string html = workspace_map(rich());
  EXPECT_EQ(count_of(html, "<svg"), 2u);  // from above and from the side
  EXPECT_TRUE(shows(html, "dots heat4"));
  CalibrationEvidence e = rich();
  for (WorkspacePoint& point : e.picture.workspace) point.predicted = 0.0;
  EXPECT_TRUE(shows(workspace_map(e), "dots heat0"));
  e.picture.workspace.clear();
  EXPECT_EQ(workspace_map(e), "");
}

TEST(CalibrationUncertainty, SingularValuesAboveOneAreKnown) {
  const std::string svg = singular_value_plot(rich());  // 10, 6.7, 3.4, 0.1
  EXPECT_EQ(count_of(svg, "class=\"fill-after\""), 3u);
  EXPECT_EQ(count_of(svg, "class=\"fill-open\""), 1u);
}

TEST(CalibrationModel, SkippedOnesHaveNoErrors) {
  const html::Section section = model_section(rich());
  EXPECT_TRUE(shows(section.body, "<td>not tested</td>"));
  EXPECT_TRUE(shows(section.body, "<td>selected</td>"));
  EXPECT_EQ(count_of(section.body, "gain-row"), 2u);
  EXPECT_TRUE(shows(section.body, "<b>gravity</b><br><small>"));
}

TEST(CalibrationModel, WithoutHeldOutRowsFittedOnesAreCompared) {
  CalibrationEvidence e = rich();
  e.model.models[0].holdout = {};
  EXPECT_TRUE(shows(model_selection_plot(e), "<b>0.100</b> mm"));
}

TEST(CalibrationSearch, ShowsItsStartsAndThoseThatDidNotArrive) {
  const std::string body = search_section(rich()).body;
  EXPECT_TRUE(shows(body, "bpnn-pso: 120 iterations, 9600 evaluations"));
  EXPECT_TRUE(shows(body, "<td>not reached</td>"));
  EXPECT_TRUE(shows(body, "id=\"convergence\""));
  CalibrationEvidence e = rich();
  e.search.summary.swarm_comparison.clear(), e.search.summary.median.clear();
  EXPECT_FALSE(shows(search_section(e).body, "<table"));
  EXPECT_FALSE(shows(search_section(e).body, "<svg"));
}

TEST(CalibrationMachine, DrawsErrorsOfMeasuredRowsAlone) {
  CalibrationEvidence e = rich();
  const std::string svg = calibrated_machine_drawing(e);
  EXPECT_TRUE(shows(svg, "off-before"));
  EXPECT_TRUE(shows(svg, "exaggerated"));
  for (PlotRow& row : e.picture.rows) row = {};
  EXPECT_FALSE(shows(calibrated_machine_drawing(e), "class=\"off-before\""));
  e.picture.joints.resize(3, 0);
  EXPECT_TRUE(shows(calibrated_machine_drawing(e), "<svg"));
  e.picture.chains.calibrated = {};
  EXPECT_EQ(calibrated_machine_drawing(e), "");
}

}  // namespace
}  // namespace kinfer::report
