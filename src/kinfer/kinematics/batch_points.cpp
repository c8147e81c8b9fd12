#include "kinfer/kinematics/batch_points.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {

struct BatchPoints::Plan {
  const batch::Kernels& kernels;
  batch::SegmentList list;
  batch::StepPlan steps;
  Eigen::Index unknowns = 0;
  std::vector<batch::Group> groups{};
  std::vector<int> targets{};  // of each group
  batch::Buffer<double> items{};
  std::vector<std::size_t> first_row{};  // of each point in an array of 3 x lanes a block
  int stride = 0, blocks = 0;

  int lanes() const { return kernels.lanes; }
  Eigen::Index points() const { return static_cast<Eigen::Index>(first_row.size()); }

  /// Where number `row` of point i stands in an array of 3 x lanes a block.
  std::size_t place(std::size_t i, int row) const { return first_row[i] + static_cast<std::size_t>(row) * lanes(); }

  std::size_t lane_numbers() const { return static_cast<std::size_t>(blocks) * 3 * lanes(); }

  void take_points(const Chain& nominal, const ParameterSet& set, const PointTable& points) {
    const std::vector<batch::Movement> movements = batch::movements_of(nominal, set);
    stride = batch::slots_of(movements) + 3;
    first_row.resize(points.measured.cols());
    for (int target = -1; target < static_cast<int>(nominal.targets.size()); ++target) {
      const auto count = static_cast<int>(points_at(target, points).size());
      if (count == 0) continue;
      batch::Group group = batch::group_at(list, nominal, target);
      group.begin = blocks;
      group.end = blocks += (count + lanes() - 1) / lanes();
      groups.push_back(group);
      targets.push_back(target);
    }
    items.reserve(static_cast<std::size_t>(blocks) * stride * lanes());
    for (std::size_t g = 0; g < groups.size(); ++g) fill(groups[g], points_at(targets[g], points), movements, points);
  }

  static std::vector<int> points_at(int target, const PointTable& points) {
    std::vector<int> list;
    for (int i = 0; i < points.measured.cols(); ++i)
      if ((points.target.empty() ? -1 : points.target[i]) == target) list.push_back(i);
    return list;
  }

  /// Lanes without a point repeat the last one, so that they compute with decent numbers.
  void fill(const batch::Group& group, const std::vector<int>& mine, const std::vector<batch::Movement>& movements,
            const PointTable& points) {
    std::vector<double> item(stride);
    for (int lane = 0; lane < (group.end - group.begin) * lanes(); ++lane) {
      const int at = group.begin * lanes() + lane;
      if (lane < static_cast<int>(mine.size())) {
        const int i = mine[lane];
        first_row[i] = static_cast<std::size_t>(at / lanes()) * 3 * lanes() + at % lanes();
        batch::write_item(movements, points.joints.col(i).data(), points.measured.col(i), item);
      }
      for (int k = 0; k < stride; ++k)
        items.data()[(static_cast<std::size_t>(at / lanes()) * stride + k) * lanes() + at % lanes()] = item[k];
    }
  }

  std::size_t workspace() const {
    return std::max(
        batch::jacobian_workspace(static_cast<int>(unknowns), lanes()),
        batch::points_workspace(static_cast<int>(unknowns), static_cast<int>(list.segments.size()), lanes()));
  }

  /// Scratch of at least this many numbers beyond the workspace, which comes first.
  double* prepare(Scratch& scratch, std::size_t more) const {
    const std::size_t own = workspace();
    scratch.reserve(own + more);
    return scratch.data() + own;
  }

  batch::JacobianJob job(const std::vector<batch::Step>& now, const Weights& weights, Scratch& scratch) const {
    return {.steps = now.data(),
            .step_count = static_cast<int>(now.size()),
            .groups = groups.data(),
            .group_count = static_cast<int>(groups.size()),
            .items = items.data(),
            .stride = stride,
            .weights = weights.data(),
            .columns = static_cast<int>(unknowns),
            .idle = steps.idle.data(),
            .idle_count = static_cast<int>(steps.idle.size()),
            .blocks = blocks,
            .workspace = scratch.data()};
  }
};

BatchPoints::BatchPoints(const Chain& nominal, const ParameterSet& set, const PointTable& points,
                         const batch::Kernels& kernels) {
  KINFER_EXPECT(has_batch_form(nominal, set), "a chain whose joints yield has no batch form");
  KINFER_EXPECT(points.joints.cols() == points.measured.cols(), "{} joint vectors for {} points", points.joints.cols(),
                points.measured.cols());
  auto plan = std::make_unique<Plan>(Plan{kernels, batch::segments_of(nominal, set, batch::BaseSide::chain),
                                          batch::steps_of(nominal, set), set.free_count()});
  plan->take_points(nominal, set, points);
  plan_ = std::move(plan);
}

BatchPoints::~BatchPoints() = default;
BatchPoints::BatchPoints(BatchPoints&&) noexcept = default;

Eigen::Index BatchPoints::points() const {
  return plan_->points();
}
Eigen::Index BatchPoints::unknowns() const {
  return plan_->unknowns;
}

BatchPoints::Weights BatchPoints::weights(const Eigen::Matrix3Xd& inverse_sd) const {
  const Plan& plan = *plan_;
  KINFER_EXPECT(inverse_sd.cols() == plan.points(), "{} weights for {} points", inverse_sd.cols(), plan.points());
  Weights weights(plan.lane_numbers());
  for (std::size_t i = 0; i < plan.first_row.size(); ++i)
    for (int row = 0; row < 3; ++row)
      weights.data()[plan.place(i, row)] = inverse_sd(row, static_cast<Eigen::Index>(i));
  return weights;
}

const double* BatchPoints::lane_errors(ConstVectorRef x, Scratch& scratch) const {
  const Plan& plan = *plan_;
  KINFER_EXPECT(x.size() == plan.unknowns, "{} values for {} free parameters", x.size(), plan.unknowns);
  double* found = plan.prepare(scratch, plan.lane_numbers());
  plan.kernels.errors({.segments = plan.list.segments.data(),
                       .segment_count = static_cast<int>(plan.list.segments.size()),
                       .groups = plan.groups.data(),
                       .group_count = static_cast<int>(plan.groups.size()),
                       .items = plan.items.data(),
                       .stride = plan.stride,
                       .x = x.data(),
                       .unknowns = static_cast<int>(plan.unknowns),
                       .errors = found,
                       .workspace = scratch.data()});
  return found;
}

void BatchPoints::errors(ConstVectorRef x, Eigen::Matrix3Xd& error, Scratch& scratch) const {
  const double* found = lane_errors(x, scratch);
  error.resize(3, plan_->points());
  for (std::size_t i = 0; i < plan_->first_row.size(); ++i)
    for (int row = 0; row < 3; ++row) error(row, static_cast<Eigen::Index>(i)) = found[plan_->place(i, row)];
}

double BatchPoints::cost(ConstVectorRef x, const Weights& weights, Scratch& scratch) const {
  const double* error = lane_errors(x, scratch);
  const auto n = static_cast<Eigen::Index>(plan_->lane_numbers());
  return Eigen::Map<const Eigen::ArrayXd>(error, n)
      .cwiseProduct(Eigen::Map<const Eigen::ArrayXd>(weights.data(), n))
      .square()
      .sum();
}

const double* BatchPoints::lane_jacobian(ConstVectorRef x, const Weights& weights, Scratch& scratch) const {
  const Plan& plan = *plan_;
  KINFER_EXPECT(x.size() == plan.unknowns, "{} values for {} free parameters", x.size(), plan.unknowns);
  const std::size_t numbers = plan.lane_numbers();
  double* found = plan.prepare(scratch, numbers * (plan.unknowns + 1));
  const std::vector<batch::Step> now = plan.steps.at(x);
  batch::JacobianJob job = plan.job(now, weights, scratch);
  job.residuals = found, job.jacobian = found + numbers;
  plan.kernels.jacobian(job);
  return found;
}

void BatchPoints::residuals(ConstVectorRef x, const Weights& weights, VectorXd& r, MatrixXd& jacobian,
                            Scratch& scratch) const {
  const Plan& plan = *plan_;
  const double* found = lane_jacobian(x, weights, scratch);
  const auto numbers = static_cast<std::ptrdiff_t>(plan.lane_numbers());
  r.resize(3 * plan.points()), jacobian.resize(3 * plan.points(), plan.unknowns);
  for (Eigen::Index k = -1; k < plan.unknowns; ++k, found += numbers) {
    double* to = k < 0 ? r.data() : jacobian.col(k).data();
    for (std::size_t i = 0; i < plan.first_row.size(); ++i)
      for (int row = 0; row < 3; ++row) to[3 * i + row] = found[plan.place(i, row)];
  }
}

double BatchPoints::normal_equations(ConstVectorRef x, const Weights& weights, MatrixXd& matrix, VectorXd& gradient,
                                     Scratch& scratch) const {
  const Plan& plan = *plan_;
  KINFER_EXPECT(x.size() == plan.unknowns, "{} values for {} free parameters", x.size(), plan.unknowns);
  const Eigen::Index n = plan.unknowns;
  const std::size_t numbers = plan.lane_numbers();
  double* found = plan.prepare(scratch, numbers + (n + 1) * (n + 1));
  const std::vector<batch::Step> now = plan.steps.at(x);
  batch::JacobianJob job = plan.job(now, weights, scratch);
  job.residuals = found, job.normal = found + numbers;
  plan.kernels.jacobian(job);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> gram(job.normal, n + 1,
                                                                                                      n + 1);
  matrix.setZero(n, n);
  matrix.triangularView<Eigen::Lower>() = gram.topLeftCorner(n, n);
  gradient = gram.row(n).head(n).transpose();
  return gram(n, n);
}

}  // namespace kinfer
