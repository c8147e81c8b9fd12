// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/batch_points.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {

struct BatchPoints::Plan {
  const batch::Kernels& kernels;
  batch::ChainPlan chain;
  Eigen::Index unknowns = 0;
  std::vector<batch::Group> groups{};
  batch::AlignedBuffer<double> items{};
  std::vector<std::size_t> first_row{};  // of each point in an array of 3 x lanes per block
  int stride = 0, blocks = 0;

  int lanes() const { return kernels.lanes; }
  Eigen::Index points() const { return static_cast<Eigen::Index>(first_row.size()); }

  /// Index of coordinate `row` of point i in an array of 3 x lanes per block.
  std::size_t place(std::size_t i, int row) const { return first_row[i] + static_cast<std::size_t>(row) * lanes(); }

  std::size_t lane_numbers() const { return static_cast<std::size_t>(blocks) * 3 * lanes(); }

  void set_points(const Chain& nominal, const PointTable& points) {
    const MatrixXd all = batch::items_of(chain.joint_motions, points, {}, kernels);
    const std::vector<batch::PointsAtTarget> by_target = batch::points_by_target(nominal, points);
    stride = static_cast<int>(all.cols());
    first_row.resize(points.measured.cols());
    for (const batch::PointsAtTarget& at : by_target) {
      batch::Group group = batch::group_at(chain.list, nominal, at.target);
      group.begin = blocks;
      group.end = blocks += (static_cast<int>(at.points.size()) + lanes() - 1) / lanes();
      groups.push_back(group);
    }
    items.reserve(static_cast<std::size_t>(blocks) * stride * lanes());
    for (std::size_t g = 0; g < groups.size(); ++g) fill(groups[g], by_target[g].points, all);
  }

  /// Lanes without a point repeat the last one, so that they compute with finite numbers.
  void fill(const batch::Group& group, const std::vector<int>& point_indices, const MatrixXd& all) {
    double* to = items.data() + static_cast<std::size_t>(group.begin) * stride * lanes();
    std::vector<int> now(lanes());
    for (int block = group.begin; block < group.end; ++block) {
      const std::size_t first = static_cast<std::size_t>(block - group.begin) * lanes();
      for (int lane = 0; lane < lanes(); ++lane) {
        now[lane] = point_indices[std::min(first + lane, point_indices.size() - 1)];
        if (first + lane < point_indices.size())
          first_row[now[lane]] = static_cast<std::size_t>(block) * 3 * lanes() + lane;
      }
      for (int k = 0; k < stride; ++k) {
        const double* column = all.col(k).data();
        for (const int i : now) *to++ = column[i];
      }
    }
  }

  std::size_t workspace() const {
    const auto segments = static_cast<int>(chain.list.segments.size()),
               screws = static_cast<int>(chain.screws.screws.size());
    return std::max(batch::jacobian_workspace(static_cast<int>(unknowns), screws, blocks, lanes()),
                    batch::points_workspace(static_cast<int>(chain.list.angles.size()), segments, lanes()));
  }

  /// Reserves `more` numbers after the workspace, and returns a pointer to them.
  double* prepare(Scratch& scratch, std::size_t more) const {
    const std::size_t own = workspace();
    scratch.reserve(own + more);
    return scratch.data() + own;
  }

  batch::Candidate at(ConstVectorRef x) const {
    KINFER_EXPECT(x.size() == unknowns, "{} values for {} free parameters", x.size(), unknowns);
    return {x.data(), chain.list.angles.data(), static_cast<int>(chain.list.angles.size())};
  }

  batch::JacobianJob job(ConstVectorRef x, const Weights& weights, Scratch& scratch) const {
    return {.screws = chain.screws.screws.data(),
            .screw_count = static_cast<int>(chain.screws.screws.size()),
            .at = at(x),
            .groups = groups.data(),
            .group_count = static_cast<int>(groups.size()),
            .items = items.data(),
            .stride = stride,
            .weights = weights.data(),
            .columns = static_cast<int>(unknowns),
            .idle = chain.screws.idle.data(),
            .idle_count = static_cast<int>(chain.screws.idle.size()),
            .blocks = blocks,
            .workspace = scratch.data()};
  }
};

BatchPoints::BatchPoints(const Chain& nominal, const ParameterSet& set, const PointTable& points,
                         const batch::Kernels& kernels) {
  KINFER_EXPECT(has_batch_form(nominal, set), "a chain whose joints yield has no batch form");
  KINFER_EXPECT(points.joints.cols() == points.measured.cols(), "{} joint vectors for {} points", points.joints.cols(),
                points.measured.cols());
  auto plan =
      std::make_unique<Plan>(Plan{kernels, batch::plan_of(nominal, set, batch::BaseSide::chain), set.free_count()});
  plan->set_points(nominal, points);
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
  std::fill_n(weights.data(), plan.lane_numbers(), 0.0);
  for (std::size_t i = 0; i < plan.first_row.size(); ++i)
    for (int row = 0; row < 3; ++row)
      weights.data()[plan.place(i, row)] = inverse_sd(row, static_cast<Eigen::Index>(i));
  return weights;
}

const double* BatchPoints::lane_errors(ConstVectorRef x, Scratch& scratch) const {
  const Plan& plan = *plan_;
  double* results = plan.prepare(scratch, plan.lane_numbers());
  batch::Candidate at = plan.at(x);
  if (plan.chain.list.is_all_in_sheets) at.angle_count = 0;
  plan.kernels.errors({.segments = plan.chain.list.segments.data(),
                       .segment_count = static_cast<int>(plan.chain.list.segments.size()),
                       .sheets = plan.chain.list.sheets.empty() ? nullptr : plan.chain.list.sheets.data(),
                       .groups = plan.groups.data(),
                       .group_count = static_cast<int>(plan.groups.size()),
                       .items = plan.items.data(),
                       .stride = plan.stride,
                       .at = at,
                       .errors = results,
                       .workspace = scratch.data()});
  return results;
}

void BatchPoints::errors(ConstVectorRef x, Eigen::Matrix3Xd& error, Scratch& scratch) const {
  const double* results = lane_errors(x, scratch);
  error.resize(3, plan_->points());
  for (std::size_t i = 0; i < plan_->first_row.size(); ++i)
    for (int row = 0; row < 3; ++row) error(row, static_cast<Eigen::Index>(i)) = results[plan_->place(i, row)];
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
  const std::size_t numbers = plan.lane_numbers();
  double* results = plan.prepare(scratch, numbers * (plan.unknowns + 1));
  batch::JacobianJob job = plan.job(x, weights, scratch);
  job.residuals = results, job.jacobian = results + numbers;
  plan.kernels.jacobian(job);
  return results;
}

void BatchPoints::residuals(ConstVectorRef x, const Weights& weights, VectorRef r, Eigen::Ref<MatrixXd> jacobian,
                            Scratch& scratch) const {
  const Plan& plan = *plan_;
  const double* results = lane_jacobian(x, weights, scratch);
  const auto numbers = static_cast<std::ptrdiff_t>(plan.lane_numbers());
  KINFER_EXPECT(r.size() == 3 * plan.points() && jacobian.rows() == r.size() && jacobian.cols() == plan.unknowns,
                "{} residuals, {} x {} derivatives", r.size(), jacobian.rows(), jacobian.cols());
  for (Eigen::Index k = -1; k < plan.unknowns; ++k, results += numbers) {
    double* to = k < 0 ? r.data() : jacobian.col(k).data();
    for (std::size_t i = 0; i < plan.first_row.size(); ++i)
      for (int row = 0; row < 3; ++row) to[3 * i + row] = results[plan.place(i, row)];
  }
}

double BatchPoints::normal_equations(ConstVectorRef x, const Weights& weights, MatrixXd& matrix, VectorXd& gradient,
                                     Scratch& scratch) const {
  const Plan& plan = *plan_;
  plan.prepare(scratch, 0);
  matrix.setZero(plan.unknowns, plan.unknowns);
  gradient.resize(plan.unknowns);
  batch::JacobianJob job = plan.job(x, weights, scratch);
  job.matrix = matrix.data(), job.gradient = gradient.data();
  return plan.kernels.jacobian(job);
}

}  // namespace kinfer
