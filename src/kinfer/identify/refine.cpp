#include "kinfer/identify/refine.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/estimate/ins_covariance.hpp"
#include "kinfer/estimate/ins_fact_rows.hpp"
#include "kinfer/identify/azimuth.hpp"
#include "kinfer/identify/named_facts.hpp"
#include "kinfer/identify/refine_setup.hpp"
#include "kinfer/inertial/sensor_judgement.hpp"

namespace kinfer {
namespace {

using Index = Eigen::Index;

constexpr double undetermined_azimuth = 0.1;  // [rad]

/// The covariance of a joint's unknowns, those of its bodies one behind the other, as the residuals inflate it.
MatrixXd joint_covariance(const InsCovariance& covariance, const InsLayout& layout, const InsBodies& bodies,
                          std::size_t first, std::size_t last) {
  const Index begin = layout.body[first], n = layout.body[last] + bodies[last].unknowns() - begin;
  return std::max(1.0, covariance.inflation.segment(begin, n).mean()) * covariance.model.block(begin, begin, n, n);
}

/// Readings of the joint's bodies where the recording begins.
std::vector<double> first_readings(const RefineSetup& setup, const InsFit& fit, std::size_t first, std::size_t last) {
  const VectorXd all = spline_value(setup.problem.grid, fit.unknowns.band, setup.problem.grid.begin);
  std::vector<double> readings;
  for (std::size_t b = first; b <= last; ++b)
    for (Index i = 0; i < std::max<Index>(1, freedoms(fit.unknowns.bodies[b].motion)); ++i)
      readings.push_back(fit.layout.channel[b] < 0 ? 0.0 : all[fit.layout.channel[b] + i]);
  return readings;
}

std::vector<std::string> names_of(const RecordedMotion& motion) {
  std::vector<std::string> names;
  for (const SegmentMotion& segment : motion.segments) names.push_back(segment.name);
  return names;
}

std::vector<FoundPlace> found_places(const MachineFacts& facts, const InsFit& fit, ConstMatrixRef covariance) {
  std::vector<FoundPlace> places;
  for (std::size_t i = 0; i < facts.places.size(); ++i) {
    const Index at = fit.layout.facts + 3 * static_cast<Index>(i);
    places.push_back({facts.places[i].name, facts.places[i].sensor, fit.unknowns.facts.places[i],
                      covariance.diagonal().segment<3>(at).cwiseSqrt()});
  }
  return places;
}

}  // namespace

Result<Refinement> refine(const InsRecording& recording, const RecordedMotion& motion, const SegmentTree& tree,
                          const std::vector<JointStart>& starts, const RefineOptions& options,
                          const Observer& observer) {
  const SensorModel grade = options.grade ? *options.grade : judged_model(recording);
  RefineSetup setup = refine_setup(recording, motion, tree, starts, grade, options.knots);
  KINFER_TRY(facts, named_facts(options.facts, names_of(motion), setup.start.bodies, setup.problem.grid,
                                setup.problem.root_stands_still));
  setup.problem.facts = facts;
  setup.start.facts = started_facts(setup.problem, layout_of(setup.problem, setup.start.bodies), setup.start);
  Refinement result;
  result.grade = grade.name;
  result.fit = fit_ins(setup.problem, setup.start, options.fit, observer);
  for (const InsReadings& readings : setup.problem.sensors) {
    result.noise.push_back(readings.noise);
    result.least.push_back(readings.least);
  }
  const InsFit& fit = result.fit;
  const auto covariance = covariance_of(setup.problem, fit.layout, fit.unknowns, options.fit.threads);
  if (!covariance) return error("the continuous-time fit has no covariance: the recording says too little");
  result.covariance = covariance->model;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const std::size_t first = setup.first_body[i], last = setup.last_body[i];
    const auto bodies = std::span(fit.unknowns.bodies).subspan(first, last - first + 1);
    RefinedJoint joint = refined_joint(starts[i].type, bodies, first_readings(setup, fit, first, last),
                                       joint_covariance(*covariance, fit.layout, fit.unknowns.bodies, first, last));
    joint.found.parent = motion.segments[starts[i].parent].name;
    joint.found.child = motion.segments[starts[i].child].name;
    if (starts[i].type == FoundJointType::revolute && joint.found.not_identifiable_in_child.size() == 1)
      joint.found.azimuth_undetermined =
          azimuth_sd(fit.layout, fit.unknowns.bodies, covariance->model, last) > undetermined_azimuth;
    result.joints.push_back(joint);
  }
  result.places = found_places(options.facts, fit, covariance->model);
  return result;
}

}  // namespace kinfer
