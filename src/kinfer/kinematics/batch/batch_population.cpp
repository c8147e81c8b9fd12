// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/batch/batch_population.hpp"

#include <algorithm>

#include "kinfer/base/aligned_buffer.hpp"
#include "kinfer/base/expect.hpp"

namespace kinfer {

template <class T>
struct BatchPopulation<T>::Plan {
  const batch::Kernels& kernels;
  batch::ChainPlan chain;
  std::vector<batch::Group> groups;
  std::vector<T> items;
  int stride = 0;
  Eigen::Index unknowns = 0;

  void set_points(const Chain& nominal, const PointTable& points) {
    const MatrixXd all = batch::items_of(chain.joint_motions, points, chain.list.base, kernels);
    stride = static_cast<int>(all.cols());
    items.reserve(all.size());
    for (const batch::PointsAtTarget& at : batch::points_by_target(nominal, points)) {
      batch::Group group = batch::group_at(chain.list, nominal, at.target);
      group.begin = groups.empty() ? 0 : groups.back().end;
      group.end = group.begin + static_cast<int>(at.points.size());
      groups.push_back(group);
      for (const int i : at.points)
        for (int k = 0; k < stride; ++k) items.push_back(static_cast<T>(all(i, k)));
    }
  }
};

template <class T>
BatchPopulation<T>::BatchPopulation(const Chain& nominal, const ParameterSet& set, const PointTable& points,
                                    const batch::Kernels& kernels) {
  KINFER_EXPECT(has_batch_form(nominal, set), "a chain whose joints yield has no batch form");
  KINFER_EXPECT(points.joints.cols() == points.measured.cols(), "{} joint vectors for {} points", points.joints.cols(),
                points.measured.cols());
  auto plan = std::make_unique<Plan>(
      Plan{kernels, batch::plan_of(nominal, set, batch::BaseSide::measurement), {}, {}, 0, set.free_count()});
  plan->set_points(nominal, points);
  plan_ = std::move(plan);
}

template <class T>
BatchPopulation<T>::~BatchPopulation() = default;
template <class T>
BatchPopulation<T>::BatchPopulation(BatchPopulation&&) noexcept = default;

template <class T>
void BatchPopulation<T>::sums(ConstMatrixRef x, std::span<double> sum) const {
  const Plan& plan = *plan_;
  KINFER_EXPECT(x.rows() == plan.unknowns, "{} values for {} free parameters", x.rows(), plan.unknowns);
  if (x.cols() == 0) return;
  const auto segments = static_cast<int>(plan.chain.list.segments.size());
  constexpr bool is_double = sizeof(T) == sizeof(double);
  const int lanes = is_double ? plan.kernels.lanes : plan.kernels.float_lanes;
  batch::AlignedBuffer<T> workspace(static_cast<std::size_t>(lanes) * (plan.unknowns + 13 * segments));
  const batch::PopulationJob<T> job{.segments = plan.chain.list.segments.data(),
                                    .segment_count = segments,
                                    .groups = plan.groups.data(),
                                    .group_count = static_cast<int>(plan.groups.size()),
                                    .items = plan.items.data(),
                                    .stride = plan.stride,
                                    .unknowns = static_cast<int>(plan.unknowns),
                                    .nominal = plan.chain.list.nominal.data(),
                                    .angles = plan.chain.list.angles.data(),
                                    .angle_count = static_cast<int>(plan.chain.list.angles.size()),
                                    .x = x.data(),
                                    .x_stride = x.outerStride(),
                                    .candidates = static_cast<int>(x.cols()),
                                    .sums = sum.data(),
                                    .workspace = workspace.data()};
  if constexpr (is_double) {
    plan.kernels.sums(job);
  } else {
    plan.kernels.float_sums(job);
  }
}

template class BatchPopulation<double>;
template class BatchPopulation<float>;

}  // namespace kinfer
